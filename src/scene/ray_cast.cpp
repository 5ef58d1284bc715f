// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

std::optional<Hit> nearest_hit(std::span<const Shape> shapes, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const Shape& shape : shapes) {
    const auto hit = std::visit([&](const auto& s) { return intersect(s, ray); }, shape);
    if (hit && (!nearest || hit->distance_m < nearest->distance_m)) nearest = hit;
  }
  return nearest;
}

SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world, const MeshSearchMaker& search_of) {
  return RayCaster(shapes, search_of).see(view, camera_to_world).image;
}

}  // namespace tofsmith

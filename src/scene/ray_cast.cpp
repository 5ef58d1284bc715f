// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_cast.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/parallel.hpp"

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
                    const Eigen::Isometry3d& camera_to_world) {
  view.validate();
  for (const Shape& shape : shapes) validate(shape);
  SceneImage scene(view.height, view.width);
  parallel_for(view.height, [&](std::int64_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < view.width; ++column) {
      const Ray ray{camera_to_world.translation(),
                    camera_to_world.linear() * view.ray(row, column)};
      const auto hit = nearest_hit(shapes, ray);
      if (!hit) continue;
      scene.depth_m(row, column) = static_cast<float>(hit->distance_m);
      scene.albedo(row, column) = static_cast<float>(hit->albedo);
      scene.cosine(row, column) =
          static_cast<float>(std::min(1.0, std::abs(hit->normal.dot(ray.direction))));
    }
  });
  return scene;
}

}  // namespace tofsmith

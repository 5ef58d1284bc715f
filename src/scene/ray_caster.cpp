// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/rigid.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world, const MeshSearchMaker& search_of) {
  return RayCaster(shapes, search_of).see(view, camera_to_world).image;
}

struct RayCaster::Prepared {
  std::vector<Shape> shapes;
  /// One per shape; null: intersected in closed form.
  std::vector<std::unique_ptr<const MeshSearch>> searches;

  void trace(std::span<const Ray> rays, std::span<NearestHit> nearest) const {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const auto index = static_cast<std::int32_t>(i);
      if (searches[i]) {
        searches[i]->trace(rays, nearest, index);
        continue;
      }
      std::visit(
          [&](const auto& shape) {
            for (std::size_t lane = 0; lane < rays.size(); ++lane)
              if (const auto hit = intersect(shape, rays[lane]);
                  hit && hit->distance_m < nearest[lane].hit.distance_m)
                nearest[lane] = {*hit, index};
          },
          shapes[i]);
    }
  }
};

RayCaster::RayCaster(std::span<const Shape> shapes, const MeshSearchMaker& search_of) {
  for (const Shape& shape : shapes) validate(shape);
  Prepared prepared;
  prepared.shapes.assign(shapes.begin(), shapes.end());
  prepared.searches.resize(shapes.size());
  for (std::size_t i = 0; search_of && i < shapes.size(); ++i)
    if (const Mesh* mesh = std::get_if<Mesh>(&prepared.shapes[i]))
      prepared.searches[i] = search_of(*mesh);
  prepared_ = make_hidden<const Prepared>(std::move(prepared));
}

std::optional<Hit> RayCaster::nearest(const Ray& ray) const {
  NearestHit nearest;
  prepared_->trace({&ray, 1}, {&nearest, 1});
  if (nearest.shape < 0) return std::nullopt;
  return nearest.hit;
}

SeenScene RayCaster::see(const PinholeView& view, const Eigen::Isometry3d& camera_to_world) const {
  return see(PixelRays(view), camera_to_world);
}

SeenScene RayCaster::see(const PixelRays& pixel_rays,
                         const Eigen::Isometry3d& camera_to_world) const {
  const PinholeView& view = pixel_rays.view();
  require_rigid(camera_to_world, "camera_to_world");
  SeenScene seen{SceneImage(view.height, view.width),
                 Image<std::int32_t>(view.height, view.width, -1)};
  const Eigen::Matrix3d turn = camera_to_world.linear();
  const Eigen::Vector3d origin = camera_to_world.translation();
  parallel_for(view.height, [&](std::int64_t line) {
    const int row = static_cast<int>(line);
    constexpr int packet = static_cast<int>(MeshSearch::packet);
    std::array<Ray, MeshSearch::packet> rays;
    for (int begin = 0; begin < view.width; begin += packet) {
      const int count = std::min(packet, view.width - begin);
      std::array<NearestHit, MeshSearch::packet> nearest;
      for (int lane = 0; lane < count; ++lane)
        rays[static_cast<std::size_t>(lane)] = {origin, turn * pixel_rays.ray(row, begin + lane)};
      const auto lanes = static_cast<std::size_t>(count);
      prepared_->trace({rays.data(), lanes}, {nearest.data(), lanes});
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const Hit& hit = nearest[lane].hit;
        const auto depth_m = static_cast<float>(hit.distance_m);
        // The distance to a plane seen edge-on may overflow.
        if (nearest[lane].shape < 0 || !std::isfinite(depth_m) || !(depth_m > 0.0f)) continue;
        const int column = begin + static_cast<int>(lane);
        seen.image.depth_m(row, column) = depth_m;
        seen.image.albedo(row, column) = static_cast<float>(hit.albedo);
        seen.image.cosine(row, column) =
            static_cast<float>(std::min(1.0, std::abs(hit.normal.dot(rays[lane].direction))));
        seen.shape(row, column) = nearest[lane].shape;
      }
    }
  });
  return seen;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "tofsmith/core/array.hpp"
#include "tofsmith/scene/mesh_search.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// What a camera sees, and whose surface it is.
struct SeenScene {
  SceneImage image;
  Image<std::int32_t> shape;  ///< index of the shape seen in a pixel; -1 = no return
};

/// Shapes made ready for many rays. Meshes are searched as the caller says; all other shapes stay
/// closed form.
/// @note immutable; thread-safe; same image for any number of threads
class RayCaster {
 public:
  /// Keeps copies of the shapes.
  /// @param search_of  how meshes are searched, such as embree_search(); empty: every triangle is
  ///                   tried, as nearest_hit does, which is slow for more than a few
  /// @throws std::invalid_argument if a shape is invalid; what `search_of` throws
  explicit RayCaster(std::span<const Shape> shapes, const MeshSearchMaker& search_of = {});
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The nearest of all intersections.
  std::optional<Hit> nearest(const Ray& ray) const;

  /// Through the centre of every pixel, the nearest surface. Rays that meet nothing return nothing
  /// (NaN). A camera inside a shape sees it from within: see check_view.hpp.
  /// @param camera_to_world  where the camera stands and looks; identity: the view's own axes
  /// @throws std::invalid_argument if the view is invalid or the pose is not rigid and finite
  SeenScene see(const PinholeView& view,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace tofsmith

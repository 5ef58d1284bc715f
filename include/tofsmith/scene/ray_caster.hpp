// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// Nearest hit and the index of its shape.
struct NearestHit {
  Hit hit{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0.0};
  std::int32_t shape = -1;
};

/// Finds the nearest hit of rays with one mesh.
/// @note immutable; trace() is thread-safe
class MeshSearch {
 public:
  static constexpr std::size_t packet = 8;  ///< maximum number of rays per call

  virtual ~MeshSearch() = default;
  /// Replaces hits that are farther than this mesh, whose index is `shape`.
  /// @param rays  at most `packet`, with one `nearest` each
  virtual void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
                     std::int32_t shape) const = 0;
};

/// Creates the search structure of a mesh, which must outlive it, e.g. embree_search(). Empty:
/// every triangle is tested.
using MeshSearchMaker = std::function<std::unique_ptr<const MeshSearch>(const Mesh& mesh)>;

/// Image with the shape in each pixel.
struct SeenScene {
  SceneImage image;
  Image<std::int32_t> shape;  ///< -1: no return
};

/// Shapes prepared for many rays. Meshes use a search structure; other shapes have closed forms.
/// @note immutable; thread-safe; the image does not depend on the number of threads
class RayCaster {
 public:
  /// Copies the shapes. @throws std::invalid_argument if one is invalid; exceptions of `search_of`
  explicit RayCaster(std::span<const Shape> shapes, const MeshSearchMaker& search_of = {});

  /// Returns the nearest hit of all shapes.
  std::optional<Hit> nearest(const Ray& ray) const;

  /// Casts a ray through the centre of every pixel. A camera inside a shape sees its inner side:
  /// see check_view().
  /// @throws std::invalid_argument if the view is invalid or the pose is not rigid and finite
  SeenScene see(const PinholeView& view,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;
  /// For precomputed rays.
  SeenScene see(const PixelRays& pixel_rays,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;

 private:
  struct Prepared;
  Hidden<const Prepared> prepared_;
};

/// Returns the image of RayCaster::see() for a single view. @throws std::invalid_argument as see()
SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity(),
                    const MeshSearchMaker& search_of = {});

/// Returns true if a point is inside a box, a sphere, a capsule or a closed mesh, in which every
/// edge belongs to an even number of triangles: rays from the point cross the mesh an odd number of
/// times, by majority of three directions.
bool is_inside(const Shape& shape, const Eigen::Vector3d& point);

/// Rejects a camera inside a solid shape, which RayCaster permits. @throws std::invalid_argument
void require_camera_outside(std::span<const Shape> shapes, const Eigen::Vector3d& camera);

/// Rejects an image without any return. @throws std::invalid_argument with advice
void require_something_in_view(const SceneImage& image);

/// Performs both checks.
void check_view(const StagedScene& scene, const SceneImage& image);

}  // namespace tofsmith

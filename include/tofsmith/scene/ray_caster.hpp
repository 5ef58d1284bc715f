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

#include "tofsmith/core/image.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// The nearest hit found, and the index of its shape.
struct NearestHit {
  Hit hit{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0.0};
  std::int32_t shape = -1;  ///< -1: none
};

/// Finds the nearest hit of rays with the triangles of one mesh.
/// @note immutable; trace() is thread-safe
class MeshSearch {
 public:
  static constexpr std::size_t packet = 8;  ///< maximum number of rays per call

  virtual ~MeshSearch() = default;
  /// Replaces hits that are farther than this mesh.
  /// @param rays     at most `packet`
  /// @param nearest  one per ray
  /// @param shape    index of the mesh
  virtual void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
                     std::int32_t shape) const = 0;
};

/// Creates the search structure of a mesh; the mesh must outlive it. An example is embree_search()
/// of tofsmith/io. If empty, every triangle is tested.
using MeshSearchMaker = std::function<std::unique_ptr<const MeshSearch>(const Mesh& mesh)>;

/// Image seen by a camera, with the shape in each pixel.
struct SeenScene {
  SceneImage image;
  Image<std::int32_t> shape;  ///< index of the shape in each pixel; -1: no return
};

/// Shapes prepared for many rays. Meshes use a search structure; other shapes are intersected in
/// closed form.
/// @note immutable; thread-safe; the image does not depend on the number of threads
class RayCaster {
 public:
  /// Copies the shapes.
  /// @param search_of  search structure for meshes, e.g. embree_search(); empty: tests every
  ///                   triangle, which is slow for large meshes
  /// @throws std::invalid_argument if a shape is invalid; exceptions of `search_of`
  explicit RayCaster(std::span<const Shape> shapes, const MeshSearchMaker& search_of = {});
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Returns the nearest hit of all shapes.
  std::optional<Hit> nearest(const Ray& ray) const;

  /// Casts a ray through the centre of every pixel. Pixels that hit nothing have no return (NaN). A
  /// camera inside a shape sees its inner side: see check_view().
  /// @param camera_to_world  pose of the camera; identity: the axes of the view
  /// @throws std::invalid_argument if the view is invalid or the pose is not rigid and finite
  SeenScene see(const PinholeView& view,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;
  /// As above with precomputed rays.
  SeenScene see(const PixelRays& pixel_rays,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

/// Returns the nearest hit, in closed form and triangle by triangle. A reference for RayCaster,
/// which is faster.
std::optional<Hit> nearest_hit(std::span<const Shape> shapes, const Ray& ray);

/// Returns the image of a pinhole camera, as RayCaster::see. Use a RayCaster for several views of a
/// scene, or to obtain the shape in each pixel.
/// @param camera_to_world  pose of the camera; identity: the axes of the view
/// @param search_of        see RayCaster
/// @throws std::invalid_argument if the view, the pose or a shape is invalid
SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity(),
                    const MeshSearchMaker& search_of = {});

/// Returns true if a point is inside a solid: a box, a sphere, a capsule or a closed mesh. Planes
/// and open meshes have no inside.
///
/// A mesh is closed if every edge, identified by the positions of its ends, belongs to an even
/// number of triangles. A point is inside if rays from it cross the mesh an odd number of times, by
/// majority of three directions; orientation does not matter.
bool is_inside(const Shape& shape, const Eigen::Vector3d& point);

/// Rejects a camera inside a solid shape, which would see only its inner side. Ray casting itself
/// permits this, for rooms.
/// @throws std::invalid_argument naming index and kind of the shape
void require_camera_outside(std::span<const Shape> shapes, const Eigen::Vector3d& camera);

/// Rejects an image without any return.
/// @throws std::invalid_argument with advice on what to change
void require_something_in_view(const SceneImage& image);

/// Performs both checks. @throws std::invalid_argument
void check_view(const StagedScene& scene, const SceneImage& image);

}  // namespace tofsmith

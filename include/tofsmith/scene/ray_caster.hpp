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

/// The nearest surface met so far, and the index of the shape it belongs to.
struct NearestHit {
  Hit hit{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0.0};
  std::int32_t shape = -1;  ///< -1: none
};

/// Finds the nearest triangle of one mesh that rays meet.
/// @note immutable; trace() may be called by several threads
class MeshSearch {
 public:
  static constexpr std::size_t packet = 8;  ///< rays at a time, at most

  virtual ~MeshSearch() = default;
  /// Replaces what is farther than this mesh.
  /// @param rays     at most `packet`
  /// @param nearest  one per ray
  /// @param shape    the mesh's index
  virtual void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
                     std::int32_t shape) const = 0;
};

/// Makes the search of a mesh that outlives it. embree_search() of tofsmith/io is one; an empty one
/// tries every triangle.
using MeshSearchMaker = std::function<std::unique_ptr<const MeshSearch>(const Mesh& mesh)>;

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
  /// (NaN). A camera inside a shape sees it from within: see check_view().
  /// @param camera_to_world  where the camera stands and looks; identity: the view's own axes
  /// @throws std::invalid_argument if the view is invalid or the pose is not rigid and finite
  SeenScene see(const PinholeView& view,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;
  /// The same, of a view whose rays are there already.
  SeenScene see(const PixelRays& pixel_rays,
                const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity()) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

/// The nearest of all intersections, each in closed form, a mesh triangle by triangle: a reference.
/// RayCaster is the fast way.
std::optional<Hit> nearest_hit(std::span<const Shape> shapes, const Ray& ray);

/// What a pinhole camera sees: the image of RayCaster::see. Build a RayCaster for several views of
/// one scene, or to learn which shape is seen where.
/// @param camera_to_world  where the camera stands and looks; identity: the view's own axes
/// @param search_of        how meshes are searched: see RayCaster
/// @throws std::invalid_argument if the view, the pose or a shape is invalid
SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity(),
                    const MeshSearchMaker& search_of = {});

/// Whether a point lies inside a solid: a box, a sphere, a capsule or a closed mesh. Planes and
/// meshes with an opening have no inside.
///
/// A mesh is closed if every edge, identified by the places of its ends, belongs to an even number
/// of triangles. A point is inside if rays from it cross the mesh an odd number of times, by the
/// majority of three directions; orientation does not matter.
bool is_inside(const Shape& shape, const Eigen::Vector3d& point);

/// Refuses a camera within a solid shape: it would see nothing but that shape's inner side, as if
/// it stood in a wall. Ray casting itself allows it, for rooms.
/// @throws std::invalid_argument naming index and kind of the shape
void require_camera_outside(std::span<const Shape> shapes, const Eigen::Vector3d& camera);

/// Refuses an image without any return.
/// @throws std::invalid_argument saying what to change
void require_something_in_view(const SceneImage& image);

/// Both, for a scene and what is seen of it.
/// @throws std::invalid_argument
void check_view(const StagedScene& scene, const SceneImage& image);

}  // namespace tofsmith

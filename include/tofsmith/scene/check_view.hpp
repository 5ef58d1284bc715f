// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"
#include "tofsmith/scene/staged_scene.hpp"

namespace tofsmith {

/// Whether a point lies inside a solid: a box, a sphere, a capsule or a closed mesh. Planes and
/// meshes with an opening have no inside.
///
/// A mesh is closed if every edge, told by the places of its ends, belongs to an even number of
/// triangles. A point is inside if rays from it cross the mesh an odd number of times, by the
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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "tofsmith/scene/mesh_search.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

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

}  // namespace tofsmith

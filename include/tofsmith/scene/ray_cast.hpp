// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// The nearest of all intersections.
std::optional<Hit> nearest_hit(std::span<const Shape> shapes, const Ray& ray);

/// What a pinhole camera sees: through the centre of every pixel, the nearest surface. Rays that
/// meet nothing return nothing (NaN).
/// @param camera_to_world  where the camera stands and looks; identity: the view's own axes
/// @throws std::invalid_argument if the view or a shape is invalid
SceneImage ray_cast(std::span<const Shape> shapes, const PinholeView& view,
                    const Eigen::Isometry3d& camera_to_world = Eigen::Isometry3d::Identity());

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// Returns the corners of a triangle in the world [m].
std::array<Eigen::Vector3d, 3> corners_in_world(const Mesh& mesh, std::size_t triangle);

/// Returns the intersection of a ray with a triangle, from either side.
std::optional<Hit> hit_triangle(const Mesh& mesh, std::size_t triangle, const Ray& ray);

/// Returns the albedo at barycentric coordinates of a triangle.
double mesh_albedo(const Mesh& mesh, std::size_t triangle, const Eigen::Vector3d& weights);

}  // namespace tofsmith

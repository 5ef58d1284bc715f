// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// The corners of a triangle [m], where the mesh stands.
std::array<Eigen::Vector3d, 3> corners_in_world(const Mesh& mesh, std::size_t triangle);

/// Where a ray meets one triangle, from either side.
std::optional<Hit> hit_triangle(const Mesh& mesh, std::size_t triangle, const Ray& ray);

/// Albedo at a point of a triangle, given by the weights of its corners.
double mesh_albedo(const Mesh& mesh, std::size_t triangle, const Eigen::Vector3d& weights);

}  // namespace tofsmith

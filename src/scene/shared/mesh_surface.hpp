// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// Returns the corners in the world [m].
std::array<Eigen::Vector3d, 3> corners_in_world(const Mesh& mesh, std::size_t triangle);

/// Accepts either side.
std::optional<Hit> hit_triangle(const Mesh& mesh, std::size_t triangle, const Ray& ray);

double mesh_albedo(const Mesh& mesh, std::size_t triangle, const Eigen::Vector3d& weights);

}  // namespace tofsmith

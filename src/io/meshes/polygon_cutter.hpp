// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// Triangulates a polygon in space, which may be concave, by clipping ears in the plane that fits
/// it. Self-intersecting polygons become a triangle fan. The run time is limited to a multiple of
/// the number of corners.
/// @param corners  at least three
void cut_into_triangles(std::span<const std::array<float, 3>> corners,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tofsmith

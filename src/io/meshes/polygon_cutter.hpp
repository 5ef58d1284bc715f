// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// Triangles of a polygon in space, as indices of its corners: ears are clipped in the plane that
/// fits it, so that corners may stand back; a polygon that crosses itself becomes a fan. Time grows
/// with the number of corners.
/// @param corners  three or more
void cut_into_triangles(std::span<const std::array<float, 3>> corners,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tofsmith

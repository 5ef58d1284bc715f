// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// Triangulates a polygon in space, which may be concave, by clipping ears in the plane that fits
/// it. Self-intersecting polygons become a triangle fan. The run time is limited to a multiple of
/// the number of corners.
/// @param corners  at least three
void cut_into_triangles(std::span<const std::array<float, 3>> corners,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

struct PolygonSoup {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 2>> textures;
  std::vector<std::uint32_t> position_of;  ///< per corner
  std::vector<std::uint32_t> texture_of;   ///< per corner; `none` without texture coordinates
  std::vector<std::size_t> face_end;       ///< first corner after each polygon
};

// Readers throw IoError with the line or byte, the value found and the value expected. Their memory
// is a small multiple of the file's size.

/// Reads any elements and lists, text or binary in either byte order.
PolygonSoup parse_ply_mesh(std::span<const std::byte> content, std::string_view file);

/// Triangulates polygons and merges equal corners. Texture coordinates are kept if all corners have
/// them.
/// @throws IoError if there are no polygons, positions are not finite, or indices are out of range
TriangleMesh triangles_of(const PolygonSoup& soup, std::string_view file);

/// Returns "" at the end of the line.
std::string_view next_word(std::string_view& line);

}  // namespace tofsmith

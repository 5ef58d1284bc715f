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

/// Polygons as a mesh file has them.
struct PolygonSoup {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 2>> textures;
  std::vector<std::uint32_t> position_of;  ///< index of every corner's position
  std::vector<std::uint32_t> texture_of;   ///< of its texture coordinates; none: it has none
  std::vector<std::size_t> face_end;       ///< of every polygon the corner behind its last one
};

// Readers of mesh files. All throw IoError with the line or byte, what was found and what was
// expected; what they hold is a small multiple of the file.

/// Vertices are three or more finite numbers; faces have three or more corners, whose indices name
/// vertices, texture coordinates and normals that are there. Everything else is skipped.
PolygonSoup parse_obj(std::string_view text, std::string_view file);

/// Any elements and lists, text or binary of either byte order; exactly the rows announced.
PolygonSoup parse_ply_mesh(std::span<const std::byte> content, std::string_view file);

/// Binary: as long as its count of triangles says. Text: ends with its endsolid.
PolygonSoup parse_stl(std::span<const std::byte> content, std::string_view file);

/// Cuts polygons into triangles and joins corners of the same place and texture coordinates, which
/// are kept if every corner has them.
/// @throws IoError for no polygons, positions that are not finite, and indices that name none
TriangleMesh triangles_of(const PolygonSoup& soup, std::string_view file);

/// Cuts the next word off a line, at blanks; "" at its end.
std::string_view next_word(std::string_view& line);

}  // namespace tofsmith

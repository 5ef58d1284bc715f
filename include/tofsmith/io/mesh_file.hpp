// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

inline constexpr std::uint64_t max_mesh_file_bytes = std::uint64_t{1} << 30;

/// Returns true for .obj, .ply and .stl.
bool is_mesh_file(const std::filesystem::path& path);

/// Reads the triangles of an OBJ, PLY or STL file (text or binary) as one mesh. Polygons are
/// triangulated, and corners with equal position and texture coordinates are merged. Texture
/// coordinates are kept if all parts have them; normals, colours and materials are ignored.
/// @param file  its extension determines the format
/// @throws IoError if the extension is unknown, the file is damaged or has no faces, and for faces
///         with fewer than three corners, indices out of range, or coordinates that are not finite
TriangleMesh parse_mesh(std::span<const std::byte> content, std::string_view file);
/// @throws IoError as parse_mesh(), or if the file exceeds max_mesh_file_bytes
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Returns a mesh search for RayCaster that uses Embree's bounding volume hierarchy and then
/// intersects in double precision. Rays within about 1e-6 of the mesh's size of an edge may hit the
/// adjacent triangle. The search throws std::runtime_error or std::bad_alloc if it cannot be built.
MeshSearchMaker embree_search();

}  // namespace tofsmith

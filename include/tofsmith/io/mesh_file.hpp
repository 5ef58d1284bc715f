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

/// Maximum size of a mesh file [bytes]. A triangle takes 15 to 200 bytes.
inline constexpr std::uint64_t max_mesh_file_bytes = std::uint64_t{1} << 30;

/// Returns true if the extension is that of a mesh: .obj, .ply or .stl.
bool is_mesh_file(const std::filesystem::path& path);

/// Reads the triangles of a Wavefront OBJ, PLY or STL file (text or binary). Polygons are
/// triangulated, all groups of the file are combined into one mesh, and corners with equal position
/// and texture coordinates are merged. Texture coordinates are kept if all parts have them.
/// Normals, colours, materials and images are ignored, and no other file is opened.
/// @param file  name for error messages; its extension determines the format
/// @throws IoError naming the file (and line or byte, if the format allows) if the extension is
///         unknown, if the file is damaged, truncated, longer than specified or without faces, and
///         for faces with fewer than three corners, indices out of range, or coordinates that are
///         not finite
TriangleMesh parse_mesh(std::span<const std::byte> content, std::string_view file);
/// @throws IoError as parse_mesh(), or if the file cannot be read or exceeds max_mesh_file_bytes
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Returns a mesh search for RayCaster, ray_cast and bounced_light. It finds triangles with
/// Embree's bounding volume hierarchy and then intersects them in double precision.
///
/// Results are the same as from testing every triangle, except for rays within about 1e-6 of
/// the mesh's (not the scene's) size of an edge, which may hit the adjacent triangle. The search
/// that it creates throws std::runtime_error or std::bad_alloc if a hierarchy cannot be built.
MeshSearchMaker embree_search();

}  // namespace tofsmith

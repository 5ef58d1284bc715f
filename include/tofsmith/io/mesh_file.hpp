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

/// Largest mesh file that is read [bytes]; a triangle takes 15 to 200.
inline constexpr std::uint64_t max_mesh_file_bytes = std::uint64_t{1} << 30;

/// Whether the extension is that of a mesh: .obj, .ply or .stl.
bool is_mesh_file(const std::filesystem::path& path);

/// The triangles of a Wavefront OBJ, PLY or STL file (text or binary). Polygons are cut into
/// triangles, all groups of the file become one mesh, and corners of the same place and texture
/// coordinates become one vertex. Texture coordinates are kept if every part has them. Normals,
/// colours, materials and pictures are left out; no other file is opened.
/// @param file  what errors call it; its extension says the format
/// @throws IoError naming the file (and line or byte, where the format allows) if the extension is
///         another, the file is damaged, cut short or longer than it says, has no faces, faces of
///         fewer than three corners, indices out of range, or coordinates that are not finite
TriangleMesh parse_mesh(std::span<const std::byte> content, std::string_view file);
/// @throws IoError as parse_mesh(), or if the file cannot be read or exceeds max_mesh_file_bytes
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Searches meshes through Embree's hierarchy of bounding boxes; the triangle found is then
/// intersected in double precision. For RayCaster, ray_cast and bounced_light of scenes with
/// meshes.
///
/// Agrees with trying every triangle but for rays that pass an edge of a mesh closer than about
/// 1e-6 of the mesh's (not the scene's) size: those may see the triangle beside it. What it makes
/// throws std::runtime_error or std::bad_alloc if a hierarchy cannot be set up.
MeshSearchMaker embree_search();

}  // namespace tofsmith

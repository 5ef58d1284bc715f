// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace tofsmith {

// Mesh files are parsed by a library that reads past what is missing and drops what does not fit.
// These look at a file before it does. All throw IoError with the line or byte.

/// Vertices are three or more finite numbers; faces have three or more corners, whose indices name
/// vertices, texture coordinates and normals that are there.
void check_obj(std::string_view text, std::string_view file);

/// The header is sound, and the file holds exactly the rows it announces.
void check_ply(std::span<const std::byte> content, std::string_view file);

/// Binary: as long as its count of triangles says. Text: ends with its endsolid.
void check_stl(std::span<const std::byte> content, std::string_view file);

}  // namespace tofsmith

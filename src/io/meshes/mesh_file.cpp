// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include "io/meshes/polygon_soup.hpp"
#include "io/shared/file_kind.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

std::string mesh_extension(const std::filesystem::path& path) {
  return known_extension(path, {".obj", ".ply", ".stl"});
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".ply" || extension == ".stl";
}

TriangleMesh parse_mesh(std::span<const std::byte> content, std::string_view file) {
  const std::string name(file);
  const std::string extension = mesh_extension(name);
  if (content.empty()) throw IoError(name, "found an empty file; expected a mesh");
  if (extension == ".obj")
    return triangles_of(
        parse_obj({reinterpret_cast<const char*>(content.data()), content.size()}, name), name);
  return triangles_of(
      extension == ".ply" ? parse_ply_mesh(content, name) : parse_stl(content, name), name);
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
  mesh_extension(path);
  return parse_mesh(read_binary_file(path, max_mesh_file_bytes), path.string());
}

}  // namespace tofsmith

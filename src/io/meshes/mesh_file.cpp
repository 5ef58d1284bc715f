// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>

#include "io/meshes/mesh_checks.hpp"
#include "io/shared/file_kind.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// There are no other files: a mesh may name materials and pictures, which are not wanted.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// What the importer reads must be sound before its next step works on it.
/// @param min_corners  OBJ has points and lines beside its faces
void check_parts(const aiScene& scene, const std::string& file, unsigned min_corners) {
  bool any = false;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw IoError(file, fmt::format("vertex {}: found ({}, {}, {}); expected finite numbers", v,
                                        p.x, p.y, p.z));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < min_corners)
        throw IoError(file, fmt::format("face {}: found {} corners; expected 3 or more", f,
                                        face.mNumIndices));
      for (unsigned k = 0; k < face.mNumIndices; ++k)
        if (face.mIndices[k] >= mesh.mNumVertices)
          throw IoError(file, fmt::format("face {}: found the vertex index {}; expected 0 .. {}", f,
                                          static_cast<std::int32_t>(face.mIndices[k]),
                                          static_cast<std::int64_t>(mesh.mNumVertices) - 1));
      any = any || face.mNumIndices >= 3;
    }
  }
  if (!any) throw IoError(file, "found no faces; expected triangles or polygons");
}

/// Collects triangles; corners that are the same become one vertex.
class Collector {
 public:
  explicit Collector(bool with_texture) : with_texture_(with_texture) {}

  void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent_to_world) {
    const aiMatrix4x4 to_world = parent_to_world * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene.mMeshes[node.mMeshes[i]], to_world);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(scene, *node.mChildren[i], to_world);
  }

  TriangleMesh mesh;

 private:
  using Corner = std::array<float, 5>;  // x, y, z, u, v
  struct HashOfCorner {
    std::size_t operator()(const Corner& corner) const {
      return std::hash<std::string_view>()(
          {reinterpret_cast<const char*>(corner.data()), sizeof(Corner)});
    }
  };

  void add(const aiMesh& part, const aiMatrix4x4& to_world) {
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      auto& triangle = mesh.triangles.emplace_back();
      for (unsigned k = 0; k < 3; ++k) triangle[k] = vertex_of(part, face.mIndices[k], to_world);
    }
  }

  std::uint32_t vertex_of(const aiMesh& part, unsigned index, const aiMatrix4x4& to_world) {
    const aiVector3D p = to_world * part.mVertices[index];
    const aiVector3D uv = with_texture_ ? part.mTextureCoords[0][index] : aiVector3D();
    // Adding 0 makes -0 and 0 the same bytes.
    const Corner corner{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, uv.x + 0.0f, uv.y + 0.0f};
    const auto [known, is_new] =
        vertex_of_.emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.emplace_back(p.x, p.y, p.z);
      if (with_texture_) mesh.texture_coordinates.emplace_back(uv.x, uv.y);
    }
    return known->second;
  }

  bool with_texture_;
  std::unordered_map<Corner, std::uint32_t, HashOfCorner> vertex_of_;
};

bool every_part_has_texture(const aiScene& scene) {
  return std::all_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes, [](const aiMesh* part) {
    return part->mNumFaces == 0 || part->HasTextureCoords(0);
  });
}

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
  // 1. Look before the importer does.
  if (content.empty()) throw IoError(name, "found an empty file; expected a mesh");
  if (extension == ".obj")
    check_obj({reinterpret_cast<const char*>(content.data()), content.size()}, name);
  else if (extension == ".ply")
    check_ply(content, name);
  else
    check_stl(content, name);

  // 2. Read, and look again before polygons are cut.
  Assimp::Importer importer;
  auto no_other_files = std::make_unique<NoOtherFiles>();
  importer.SetIOHandler(no_other_files.release());  // which it owns
  const aiScene* scene =
      importer.ReadFileFromMemory(content.data(), content.size(), 0, extension.c_str() + 1);
  if (!scene || !scene->mRootNode)
    throw IoError(name, fmt::format("cannot be read as a mesh: {}", importer.GetErrorString()));
  check_parts(*scene, name, extension == ".obj" ? 1 : 3);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene)
    throw IoError(name, fmt::format("cannot be cut into triangles: {}", importer.GetErrorString()));

  // 3. Gather.
  Collector collector(every_part_has_texture(*scene));
  collector.add(*scene, *scene->mRootNode, aiMatrix4x4());
  try {
    collector.mesh.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(name, error.what());
  }
  return std::move(collector.mesh);
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
  mesh_extension(path);
  return parse_mesh(read_binary_file(path, max_mesh_file_bytes), path.string());
}

}  // namespace tofsmith

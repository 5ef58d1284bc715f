// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "tofsmith/scene/texture.hpp"

namespace tofsmith {

/// Triangles that share vertices, in units of their own.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
  /// (u, v) of every vertex, u to the right and v up over the texture's image; may be empty.
  std::vector<Eigen::Vector2d> texture_coordinates;

  /// @throws std::invalid_argument for no triangles, an index out of range, a vertex that is not
  ///         finite, or texture coordinates that are not one per vertex: naming which and its value
  void validate() const;
};

/// A mesh placed in the world.
struct Mesh {
  TriangleMesh triangles;
  double scale_m = 1.0;  ///< metres per unit of the mesh, > 0
  Eigen::Isometry3d mesh_to_world = Eigen::Isometry3d::Identity();  ///< applied after scaling
  /// Without texture coordinates: patterns run along the mesh's own x and y axes [m].
  Texture texture;
};

}  // namespace tofsmith

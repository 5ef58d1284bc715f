// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/built_in_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tofsmith {
namespace {

/// The mesh is far from the origin.
TriangleMesh tetrahedron(double size) {
  TriangleMesh mesh;
  for (const auto& corner : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0),
                             Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 3)})
    mesh.vertices.push_back(size * (corner + Eigen::Vector3d(100, -50, 7)));
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  return mesh;
}

TEST(FramedMesh, FillsFourFifthsOfTheImage) {
  for (const double size : {1e-3, 1.0, 1e3})
    for (const auto& [width, height] : {std::pair(320, 240), std::pair(100, 400)}) {
      const StagedScene scene = framed_mesh(tetrahedron(size), 0.5, width, height);
      const Mesh& mesh = std::get<Mesh>(scene.shapes.at(0));
      double filled = 0.0;
      for (const Eigen::Vector3d& vertex : mesh.triangles.vertices) {
        const Eigen::Vector3d at = mesh.mesh_to_world * (mesh.scale_m * vertex);
        EXPECT_GT(at.z(), 0.0);
        filled = std::max({filled, 2.0 * scene.view.fx_px * std::abs(at.x() / at.z()) / width,
                           2.0 * scene.view.fy_px * std::abs(at.y() / at.z()) / height});
      }
      EXPECT_NEAR(filled, 0.8, 1e-6) << size << " " << width;
    }
}

TEST(FramedMesh, ShowsTheMeshUprightFromItsFront) {
  const StagedScene scene = framed_mesh(tetrahedron(1.0), 1.0, 320, 240);
  const Mesh& mesh = std::get<Mesh>(scene.shapes.at(0));
  const auto place = [&](int i) {
    return Eigen::Vector3d(mesh.mesh_to_world * mesh.triangles.vertices[static_cast<size_t>(i)]);
  };
  EXPECT_GT(place(1).x(), place(0).x());
  EXPECT_LT(place(2).y(), place(0).y()) << "the world's y axis goes down";
  EXPECT_LT(place(3).z(), place(0).z()) << "the mesh's z axis comes towards the camera";
}

TEST(FramedMesh, RejectsMeshesWithoutExtent) {
  TriangleMesh point;
  point.vertices = {{1, 2, 3}};
  point.triangles = {{0, 0, 0}};
  EXPECT_THROW(framed_mesh(point, 1.0, 32, 24), std::invalid_argument);
  EXPECT_THROW(framed_mesh(tetrahedron(1.0), 0.0, 32, 24), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

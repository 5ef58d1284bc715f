// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/built_in_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Mesh files have y up, the world has y down; a rotation about x keeps the front visible.
const Eigen::Matrix3d turn = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();

Eigen::AlignedBox3d box_of(const TriangleMesh& triangles) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : triangles.vertices) box.extend(vertex);
  require(box.diagonal().norm() > 0.0, "mesh", "a single point", "must have an extent");
  return box;
}

}  // namespace

Mesh upright_mesh(TriangleMesh triangles, double scale_m, const Eigen::Vector3d& centre_m) {
  const Eigen::Vector3d middle = box_of(triangles).center();
  Mesh mesh{.triangles = std::move(triangles), .scale_m = scale_m};
  mesh.mesh_to_world.linear() = turn;
  mesh.mesh_to_world.translation() = centre_m - scale_m * (turn * middle);
  return mesh;
}

StagedScene framed_mesh(TriangleMesh triangles, double scale_m, int width, int height) {
  constexpr double filled = 0.8;
  require(std::isfinite(scale_m) && scale_m > 0.0, "scale_m", scale_m, "must be finite and > 0");
  triangles.validate();
  StagedScene scene;
  scene.view = PinholeView::centred(width, height, std::numbers::pi / 3);

  const Eigen::AlignedBox3d box = box_of(triangles);

  // Smallest distance at which every vertex is in the middle part of the image and in front of the
  // camera.
  const double half_width = 0.5 * filled * width / scene.view.fx_px;
  const double half_height = 0.5 * filled * height / scene.view.fy_px;
  const double half_diagonal_m = 0.5 * scale_m * box.diagonal().norm();
  require(half_diagonal_m > 0.0, "mesh", "a single point", "must have an extent");
  double distance_m = 0.0;
  for (const Eigen::Vector3d& vertex : triangles.vertices) {
    const Eigen::Vector3d at = scale_m * (turn * (vertex - box.center()));
    const double wanted =
        std::max(std::abs(at.x()) / half_width, std::abs(at.y()) / half_height) - at.z();
    distance_m = std::max({distance_m, wanted, 0.01 * half_diagonal_m - at.z()});
  }
  scene.shapes.emplace_back(upright_mesh(std::move(triangles), scale_m, {0.0, 0.0, distance_m}));
  return scene;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/shared/mesh_surface.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith {

void TriangleMesh::validate() const {
  require(!triangles.empty(), "mesh.triangles", 0, "must be at least one");
  for (std::size_t i = 0; i < vertices.size(); ++i)
    require(vertices[i].allFinite(), fmt::format("mesh.vertices[{}]", i), vertices[i].transpose(),
            "must be finite");
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t index : triangles[i])
      require(index < vertices.size(), fmt::format("mesh.triangles[{}]", i), index,
              fmt::format("must be below {}, the number of vertices", vertices.size()));
  require(texture_coordinates.empty() || texture_coordinates.size() == vertices.size(),
          "mesh.texture_coordinates", texture_coordinates.size(),
          fmt::format("must be {}, one per vertex", vertices.size()));
  for (std::size_t i = 0; i < texture_coordinates.size(); ++i)
    require(texture_coordinates[i].allFinite(), fmt::format("mesh.texture_coordinates[{}]", i),
            texture_coordinates[i].transpose(), "must be finite");
}

std::array<Eigen::Vector3d, 3> corners_in_world(const Mesh& mesh, std::size_t triangle) {
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = mesh.mesh_to_world *
                 (mesh.scale_m * mesh.triangles.vertices[mesh.triangles.triangles[triangle][k]]);
  return corners;
}

std::optional<Hit> hit_triangle(const Mesh& mesh, std::size_t triangle, const Ray& ray) {
  const auto [a, b, c] = corners_in_world(mesh, triangle);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double facing = normal.dot(ray.direction);
  if (facing == 0.0) return std::nullopt;
  const double distance_m = normal.dot(a - ray.origin) / facing;
  if (!(distance_m > 0.0)) return std::nullopt;
  const Eigen::Vector3d point = ray.origin + distance_m * ray.direction;
  const double area = normal.squaredNorm();
  const Eigen::Vector3d weights((c - b).cross(point - b).dot(normal) / area,
                                (a - c).cross(point - c).dot(normal) / area,
                                (b - a).cross(point - a).dot(normal) / area);
  if (!(weights.minCoeff() >= 0.0)) return std::nullopt;
  return Hit{distance_m, normal.normalized(), mesh_albedo(mesh, triangle, weights)};
}

double mesh_albedo(const Mesh& mesh, std::size_t triangle, const Eigen::Vector3d& weights) {
  if (mesh.texture.pattern == Texture::Pattern::uniform) return mesh.texture.albedo;
  const auto& corner = mesh.triangles.triangles[triangle];
  const auto& uv = mesh.triangles.texture_coordinates;
  if (mesh.texture.pattern == Texture::Pattern::image && !uv.empty()) {
    const Eigen::Vector2d at =
        weights[0] * uv[corner[0]] + weights[1] * uv[corner[1]] + weights[2] * uv[corner[2]];
    return mesh.texture.image_at(at.x(), at.y());
  }
  const auto& vertex = mesh.triangles.vertices;
  const Eigen::Vector3d own =
      mesh.scale_m * (weights[0] * vertex[corner[0]] + weights[1] * vertex[corner[1]] +
                      weights[2] * vertex[corner[2]]);
  return mesh.texture.at(own.x(), own.y());
}

std::optional<Hit> intersect(const Mesh& mesh, const Ray& ray) {
  std::optional<Hit> nearest;
  for (std::size_t i = 0; i < mesh.triangles.triangles.size(); ++i)
    if (const auto hit = hit_triangle(mesh, i, ray);
        hit && (!nearest || hit->distance_m < nearest->distance_m))
      nearest = hit;
  return nearest;
}

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

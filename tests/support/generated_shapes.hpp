// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "core/shared/random.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// Points (N, rank) of a closed curve.
using Curve = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Curve random_smooth_curve(int rank, int samples, std::uint64_t seed) {
  RandomStream random(seed, 0);
  Curve curve = Curve::Zero(samples, rank);
  for (int j = 0; j < rank; ++j)
    for (int harmonic = 1; harmonic <= (rank + 2) / 2; ++harmonic) {
      const double cosine = random.normal() / harmonic, sine = random.normal() / harmonic;
      for (int n = 0; n < samples; ++n) {
        const double phase = 2.0 * std::numbers::pi * harmonic * n / samples;
        curve(n, j) += cosine * std::cos(phase) + sine * std::sin(phase);
      }
    }
  return curve;
}

inline TriangleMesh icosahedron() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.normalize();
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

inline TriangleMesh subdivided(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.vertices = coarse.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] = middles.try_emplace(
        {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back((fine.vertices[a] + fine.vertices[b]).normalized());
    return found->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

/// The unit sphere as 20 * 4^times triangles.
inline TriangleMesh tessellated_sphere(int times) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < times; ++i) mesh = subdivided(mesh);
  return mesh;
}

/// Edge length 1, centred on the origin.
inline TriangleMesh unit_cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A random ray that starts near the origin; deterministic per item.
inline Ray ray_about_origin(std::uint64_t item, double spread_m = 3.0) {
  RandomStream random(27, item);
  const Eigen::Vector3d origin(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  return {spread_m * origin, direction.normalized()};
}

/// Returns the nearest hit without a search structure: a slow reference for RayCaster.
inline std::optional<Hit> nearest_hit(std::span<const Shape> shapes, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const Shape& shape : shapes) {
    const auto hit = std::visit([&](const auto& s) { return intersect(s, ray); }, shape);
    if (hit && (!nearest || hit->distance_m < nearest->distance_m)) nearest = hit;
  }
  return nearest;
}

inline Mesh placed_mesh(TriangleMesh triangles, const Eigen::Vector3d& place, double scale_m) {
  Mesh mesh;
  mesh.triangles = std::move(triangles);
  mesh.scale_m = scale_m;
  mesh.mesh_to_world.translate(place);
  mesh.mesh_to_world.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d(2, -1, 0.5).normalized()));
  return mesh;
}

inline SceneImage table_top_image(int width, int height) {
  const StagedScene scene = built_in_scene("table-top", width, height);
  return ray_cast(scene.shapes, scene.view, scene.camera_to_world);
}

}  // namespace tofsmith

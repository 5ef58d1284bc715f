// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/shared/random.hpp"
#include "generated_shapes.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {
namespace {

std::vector<Shape> mixed_scene() {
  Mesh ball = placed_mesh(tessellated_sphere(3), {1.0, -0.5, 0.7}, 0.9);
  ball.texture = {Texture::Pattern::checker, 0.2, 0.9, 0.15};
  return {Plane{.point = {0, 3, 0}, .normal = {0.1, -1, 0.2}, .texture = {.albedo = 0.15}},
          ball,
          Sphere{.centre = {-1, 0.5, 1}, .radius_m = 0.8, .texture = {.albedo = 0.35}},
          Box{.centre = {0.3, 0.2, -1.5}, .size_m = {1, 2, 0.7}, .texture = {.albedo = 0.45}},
          Capsule{.start = {1, 1, -1}, .end = {-1, -1, 1.5}, .radius_m = 0.3},
          placed_mesh(unit_cube(), {-0.8, -1.2, -0.6}, 1.3)};
}

void expect_equal(const std::optional<Hit>& hit, const std::optional<Hit>& expected, double scale_m,
                  std::uint64_t item) {
  ASSERT_EQ(hit.has_value(), expected.has_value()) << "ray " << item;
  if (!hit) return;
  EXPECT_NEAR(hit->distance_m, expected->distance_m, 1e-12 * scale_m) << "ray " << item;
  EXPECT_NEAR((hit->normal - expected->normal).norm(), 0.0, 1e-9) << "ray " << item;
  EXPECT_DOUBLE_EQ(hit->albedo, expected->albedo) << "ray " << item;
}

TEST(EmbreeSearch, FindsTheHitsOfTheReferenceInDoublePrecision) {
  const std::vector<Shape> shapes = mixed_scene();
  const RayCaster caster(shapes, embree_search());
  int hits = 0, checkered = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Ray ray = ray_about_origin(i, 1.5);
    const auto expected = nearest_hit(shapes, ray);
    hits += expected.has_value();
    checkered += expected && (expected->albedo == 0.2 || expected->albedo == 0.9);
    expect_equal(caster.nearest(ray), expected, 10.0, i);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(checkered, 100) << "on the mesh";
}

TEST(EmbreeSearch, DistantMeshesAndCamerasKeepTheirPrecision) {
  const Eigen::Vector3d far_m(3e6, -2e6, 5e6);
  const std::vector<Shape> shapes = {placed_mesh(tessellated_sphere(2), far_m, 0.1)};
  const RayCaster caster(shapes, embree_search());
  int hits = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Ray ray = ray_about_origin(i, 1.0);
    RandomStream random(28, i);
    const Eigen::Vector3d aim(random.normal(), random.normal(), random.normal());
    // From nearby and from 10 km.
    ray.origin = far_m - (i % 2 ? 1.0 : 1e4) * ray.direction + 0.05 * aim;
    const auto expected = nearest_hit(shapes, ray);
    const auto hit = caster.nearest(ray);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (!hit) continue;
    ++hits;
    // The spacing of doubles at 6e6 m is 1e-9 m.
    EXPECT_NEAR(hit->distance_m, expected->distance_m, 2e-8) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(EmbreeSearch, IsIndependentOfTheScaleOfAMesh) {
  for (const double scale_m : {1e-9, 1e-3, 1e3, 1e9}) {
    const std::vector<Shape> shapes = {
        placed_mesh(tessellated_sphere(2), scale_m * Eigen::Vector3d(0.1, 0.2, 3), scale_m)};
    const RayCaster caster(shapes, embree_search());
    int hits = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
      Ray ray = ray_about_origin(i, scale_m);
      ray.direction =
          (scale_m * Eigen::Vector3d(0.1, 0.2, 3) + 0.2 * ray.origin - ray.origin).normalized();
      const auto expected = nearest_hit(shapes, ray);
      hits += expected.has_value();
      expect_equal(caster.nearest(ray), expected, 10 * scale_m, i);
    }
    EXPECT_GT(hits, 150) << scale_m;
  }
}

TEST(EmbreeSearch, NoRayPassesBetweenAdjacentTriangles) {
  // Rays from within a closed mesh, towards its vertices and the midpoints of its edges.
  const Mesh ball = placed_mesh(tessellated_sphere(2), {0.3, 0.1, 0.2}, 1.0);
  const RayCaster caster(std::vector<Shape>{ball}, embree_search());
  const Eigen::Vector3d eye(0.35, 0.05, 0.1);
  const auto placed = [&](std::uint32_t index) {
    return Eigen::Vector3d(ball.mesh_to_world * ball.triangles.vertices[index]);
  };
  for (const auto& corner : ball.triangles.triangles)
    for (const Eigen::Vector3d& aim :
         {placed(corner[0]), Eigen::Vector3d(0.5 * (placed(corner[0]) + placed(corner[1])))}) {
      const auto hit = caster.nearest({eye, (aim - eye).normalized()});
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->distance_m, (aim - eye).norm(), 1e-6);
    }
}

TEST(EmbreeSearch, FlatSurfacesKeepTheirExactDepthAcrossEdges) {
  Mesh quad;
  quad.triangles.vertices = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
  quad.triangles.triangles = {{0, 1, 2}, {0, 2, 3}};
  const RayCaster caster(std::vector<Shape>{quad}, embree_search());
  for (int i = -9; i <= 9; ++i) {  // along the diagonal
    const Eigen::Vector3d aim(0.1 * i, 0.1 * i, 2);
    const auto hit = caster.nearest({{0, 0, 0}, aim.normalized()});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, aim.norm(), 1e-14);
  }
}

TEST(EmbreeSearch, RaysThatStartOnAMeshLeaveIt) {
  const std::vector<Shape> cube = {placed_mesh(unit_cube(), {0, 0, 0}, 1.0)};
  const RayCaster caster(cube, embree_search());
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Ray in = ray_about_origin(i, 0.1);
    const auto first = caster.nearest(in);
    ASSERT_TRUE(first);
    const Eigen::Vector3d on_surface = in.origin + first->distance_m * in.direction;
    const auto next = caster.nearest({on_surface, in.direction});
    EXPECT_TRUE(!next || next->distance_m < 1e-12) << "the surface itself, by rounding, or nothing";
    const auto back = caster.nearest({on_surface, -in.direction});
    ASSERT_TRUE(back);
    EXPECT_GT(back->distance_m, 0.0);
  }
}

TEST(EmbreeSearch, TrianglesWithoutAreaAreInvisible) {
  Mesh slivers;
  slivers.triangles.vertices = {{0, 0, 1}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}};
  slivers.triangles.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 4, 4}};
  const PinholeView view = PinholeView::centred(33, 33, 1.5);
  EXPECT_EQ(RayCaster(std::vector<Shape>{slivers}, embree_search()).see(view).shape.pixels,
            std::vector<std::int32_t>(33 * 33, -1));
  // They do not affect an adjacent triangle with area; a needle causes no NaN.
  slivers.triangles.triangles.push_back({0, 3, 4});
  slivers.triangles.vertices.push_back({1, 1e-9, 1});
  slivers.triangles.triangles.push_back({0, 3, 5});
  const SeenScene seen = RayCaster(std::vector<Shape>{slivers}, embree_search()).see(view);
  seen.image.validate();
  EXPECT_EQ(seen.shape(17, 17), 0);
}

TEST(EmbreeSearch, KeepsDenormalNumbersEnabled) {
  // Ray tracers often enable flush-to-zero mode, which must not remain set in shared threads.
  const RayCaster caster(mixed_scene(), embree_search());
  (void)caster.see(PinholeView::centred(64, 64, 1.0));
  parallel_for(64, [](std::int64_t) {
    volatile double smallest = std::numeric_limits<double>::min();
    EXPECT_GT(smallest / 4, 0.0);
    volatile float small = std::numeric_limits<float>::min();
    EXPECT_GT(small / 4, 0.0f);
  });
}

}  // namespace
}  // namespace tofsmith

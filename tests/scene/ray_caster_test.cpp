// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "generated_meshes.hpp"

namespace tofsmith {
namespace {

TEST(RayCaster, TestsEveryTriangleOfAMeshByDefault) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(tessellated_sphere(1), {0, 0, 2}, 1.0)};
  const RayCaster caster(shapes);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Ray ray = ray_about_origin(i);
    const auto hit = caster.nearest(ray), expected = nearest_hit(shapes, ray);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (hit) {
      EXPECT_EQ(hit->distance_m, expected->distance_m) << i;
    }
  }
}

struct NearSearch final : MeshSearch {
  void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
             std::int32_t shape) const override {
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
      nearest[lane] = {{1.0, -rays[lane].direction, 0.5}, shape};
  }
};

TEST(RayCaster, UsesTheGivenMeshSearch) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(unit_cube(), {0, 0, 900}, 1.0)};
  const auto searched = [](const Mesh& mesh) -> std::unique_ptr<const MeshSearch> {
    EXPECT_EQ(mesh.triangles.triangles.size(), unit_cube().triangles.size());
    return std::make_unique<NearSearch>();
  };
  const SeenScene seen = RayCaster(shapes, searched).see(PinholeView::centred(9, 7, 1.0));
  EXPECT_EQ(seen.shape.pixels, std::vector<std::int32_t>(9 * 7, 1));
  EXPECT_EQ(seen.image.depth_m(3, 3), 1.0f);
}

TEST(RayCaster, ReportsTheVisibleShape) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(unit_cube(), {0, 0, 3}, 0.5),
                                     Sphere{.centre = {0.6, 0, 3}, .radius_m = 0.2}};
  const PinholeView view = PinholeView::centred(61, 41, 1.0);
  const SeenScene seen = RayCaster(shapes).see(view);
  EXPECT_EQ(seen.shape(0, 0), 0);
  EXPECT_EQ(seen.shape(20, 30), 1);
  std::vector<int> counts(3);
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column) {
      const std::int32_t shape = seen.shape(row, column);
      ASSERT_GE(shape, 0);
      ++counts[static_cast<std::size_t>(shape)];
      const auto alone = nearest_hit(std::span(&shapes[static_cast<std::size_t>(shape)], 1),
                                     {{0, 0, 0}, view.ray(row, column)});
      ASSERT_TRUE(alone);
      EXPECT_FLOAT_EQ(seen.image.depth_m(row, column), static_cast<float>(alone->distance_m));
    }
  EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 20);
}

TEST(RayCaster, RejectsInvalidShapesAndPoses) {
  Mesh broken = placed_mesh(unit_cube(), {0, 0, 2}, 1.0);
  broken.triangles.vertices[0].x() = NAN;
  EXPECT_THROW(RayCaster(std::vector<Shape>{broken}), std::invalid_argument);
  const RayCaster nothing(std::vector<Shape>{});
  EXPECT_FALSE(nothing.nearest(ray_about_origin(1)));
  const PinholeView view = PinholeView::centred(8, 8, 1.0);
  EXPECT_EQ(nothing.see(view).shape.pixels, std::vector<std::int32_t>(64, -1));
  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear() *= 1.1;
  EXPECT_THROW(nothing.see(view, stretched), std::invalid_argument);
  EXPECT_THROW(nothing.see(PinholeView{}), std::invalid_argument);
}

TEST(RayCaster, APlaneBeyondTheRangeOfFloatsReturnsNothing) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 1e60}}};
  const SeenScene seen = RayCaster(shapes).see(PinholeView::centred(4, 4, 1.0));
  seen.image.validate();
  EXPECT_EQ(seen.shape.pixels, std::vector<std::int32_t>(16, -1));
}

}  // namespace
}  // namespace tofsmith

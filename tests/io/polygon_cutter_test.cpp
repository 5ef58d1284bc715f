// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/polygon_cutter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "core/shared/random.hpp"
#include "sanitizers.hpp"

namespace tofsmith {
namespace {

using Corners = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles cut(const Corners& corners) {
  Triangles triangles;
  cut_into_triangles(corners, triangles);
  return triangles;
}

Eigen::Vector3d at(const Corners& corners, std::size_t i) {
  const auto& p = corners[i % corners.size()];
  return {p[0], p[1], p[2]};
}

/// Twice the area, as a vector along the normal.
Eigen::Vector3d area_of(const Corners& corners) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) area += at(corners, i).cross(at(corners, i + 1));
  return area;
}

/// The star has concave corners and a random orientation.
Corners star(RandomStream& random, int count) {
  const Eigen::Quaterniond turned(
      Eigen::Vector4d(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized());
  Corners corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = 0.2 + random.uniform();
    const Eigen::Vector3d p =
        turned * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    corners.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return corners;
}

TEST(PolygonCutter, TrianglesCoverThePolygonOnceWithItsOrientation) {
  RandomStream random(5, 1);
  for (int round = 0; round < 300; ++round) {
    const Corners corners = star(random, 3 + round % 40);
    const Eigen::Vector3d whole = area_of(corners), normal = whole.normalized();
    const Triangles triangles = cut(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles) {
      const double area =
          normal.dot((at(corners, b) - at(corners, a)).cross(at(corners, c) - at(corners, a)));
      EXPECT_GE(area, -1e-6) << round;  // no triangle is flipped, so none overlaps another
      sum += area;
    }
    EXPECT_NEAR(sum, whole.norm(), 1e-5) << round;
  }
}

TEST(PolygonCutter, AFlatOrCrossedPolygonIsTriangulated) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2u);
  EXPECT_EQ(cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).size(), 3u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
}

TEST(PolygonCutter, EveryCornerOfALongPolygonIsInATriangle) {
  RandomStream random(6, 1);
  const Corners corners = star(random, repetitions(100'000));
  std::set<std::uint32_t> used;
  for (const auto& triangle : cut(corners)) used.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(used.size(), corners.size());
}

}  // namespace
}  // namespace tofsmith

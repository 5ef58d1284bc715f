// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/surface_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Points of a tilted wall about 2 m away, off it by `noise_m`.
Points wall(int count, double noise_m, RandomStream& random) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, 1).normalized();
  Points points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p(random.uniform() - 0.5, random.uniform() - 0.5, 2.0);
    points.push_back(p + (noise_m * random.normal() - normal.dot(p) + 2.0) * normal);
  }
  return points;
}

/// The side of a ball of 20 cm at 1 m that faces the origin.
Points ball(int count, double noise_m, RandomStream& random) {
  Points points;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    if (direction.z() < -0.2)
      points.push_back(Eigen::Vector3d(0.1, -0.05, 1.0) +
                       (0.2 + noise_m * random.normal()) * direction);
  }
  return points;
}

TEST(SurfaceFit, FindsThePlaneAndTheSphereThatPointsLieOn) {
  RandomStream random(31, 0);
  const Points on_wall = wall(200, 0.0, random), on_ball = ball(200, 0.0, random);
  const SurfaceFit<Plane> plane = fit_plane(on_wall);
  EXPECT_LT(plane.rms_m, 1e-12);
  EXPECT_EQ(plane.used, 200);
  const SurfaceFit<Sphere> sphere = fit_sphere(on_ball);
  EXPECT_NEAR(sphere.surface.radius_m, 0.2, 1e-9);
  EXPECT_LT((sphere.surface.centre - Eigen::Vector3d(0.1, -0.05, 1.0)).norm(), 1e-9);
  for (const double r : residuals_along_rays(plane.surface, on_wall)) EXPECT_NEAR(r, 0, 1e-9);
}

TEST(SurfaceFit, OutliersAndHolesDoNotMoveIt) {
  RandomStream random(32, 0);
  for (int trial = 0; trial < 5; ++trial) {
    Points on_wall = wall(300, 0.003, random), on_ball = ball(300, 0.003, random);
    for (Points* points : {&on_wall, &on_ball}) {
      for (std::size_t i = 0; i < 90; ++i)  // 30 %, anywhere on their rays
        (*points)[3 * i] *= 0.2 + 20 * random.uniform();
      points->push_back(Eigen::Vector3d(0, 0, std::nan("")));
    }
    const SurfaceFit<Plane> plane = fit_plane(on_wall);
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, 1).normalized();
    EXPECT_GT(std::abs(plane.surface.normal.dot(normal)), std::cos(0.005));
    EXPECT_NEAR(std::abs(plane.surface.normal.dot(plane.surface.point)), 2.0, 0.002);
    EXPECT_NEAR(plane.used, 210, 10);
    const SurfaceFit<Sphere> sphere = fit_sphere(on_ball);
    EXPECT_NEAR(sphere.surface.radius_m, 0.2, 0.003);
    EXPECT_LT((sphere.surface.centre - Eigen::Vector3d(0.1, -0.05, 1.0)).norm(), 0.003);
    EXPECT_NEAR(sphere.rms_m, 0.003, 0.001);
  }
}

TEST(SurfaceFit, IsTheLeastSquaresOptimum) {
  RandomStream random(33, 0);
  const Points points = ball(100, 0.01, random);
  const Sphere best =
      fit_sphere(points, {.trim_sigma = std::numeric_limits<double>::infinity()}).surface;
  const auto cost = [&](const Sphere& s) {
    double sum = 0;
    for (const auto& p : points) sum += std::pow((p - s.centre).norm() - s.radius_m, 2);
    return sum;
  };
  for (int axis = 0; axis < 4; ++axis)
    for (const double step : {-1e-4, 1e-4}) {
      Sphere moved = best;
      (axis < 3 ? moved.centre[axis] : moved.radius_m) += step;
      EXPECT_GT(cost(moved), cost(best));
    }
}

TEST(SurfaceFit, ResidualsAreDepthErrorsAlongTheRay) {
  const Plane plane{.point = {0, 0, 2}, .normal = {0, 0, 1}, .texture = {}};
  const Eigen::Vector3d direction = Eigen::Vector3d(0.6, 0, 0.8);
  const Sphere sphere{.centre = {0, 0, 1}, .radius_m = 0.2, .texture = {}};
  EXPECT_NEAR(residuals_along_rays(plane, {2.6 * direction})[0], 0.1, 1e-12);
  EXPECT_NEAR(residuals_along_rays(plane, {2.4 * direction})[0], -0.1, 1e-12);
  EXPECT_NEAR(residuals_along_rays(sphere, {{0, 0, 0.85}})[0], 0.05, 1e-12);
  EXPECT_TRUE(std::isnan(residuals_along_rays(sphere, {{1, 0, 1}})[0]));
  EXPECT_TRUE(std::isnan(residuals_along_rays(plane, {{0, 0, std::nan("")}})[0]));
}

TEST(SurfaceFit, RefusesPointsThatDefineNoSurface) {
  RandomStream random(34, 0);
  EXPECT_THROW(fit_plane({{0, 0, 1}, {0, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(fit_plane({{0, 0, 1}, {0, 1, 1}, {0, 2, 1}, {0, 5, 1}}), std::invalid_argument);
  EXPECT_THROW(fit_sphere({{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}), std::invalid_argument);
  EXPECT_THROW(fit_sphere({{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}, {2, 3, 1}}),
               std::invalid_argument);
  EXPECT_THROW(fit_plane(wall(9, 0, random), {.trim_sigma = 0}), std::invalid_argument);
  EXPECT_THROW(fit_plane(wall(9, 0, random), {.samplings = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/lens_distortion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tofsmith {
namespace {

using Eigen::Vector2d;

/// Typical lenses, from mild to strong distortion.
std::vector<LensDistortion> lenses() {
  using enum DistortionModel;
  return {{opencv, {-0.28, 0.07, 1e-3, -5e-4}},
          {opencv, {0.12, -0.2, -1e-3, 2e-3, 0.05}},
          {opencv, {0.42, -2.6, 6e-4, -2e-4, 1.5, 0.31, -2.4, 1.42}},  // a depth camera
          {opencv, {-0.1, 0.02, 0, 0, 0, 0.2, 0.01, 0, 3e-3, -1e-3, -2e-3, 5e-4}},
          {opencv, {-0.1, 0.02, 0, 0, 0, 0.2, 0.01, 0, 3e-3, -1e-3, -2e-3, 5e-4, 0, 0}},
          {rational_6kt, {0.92, 0.5, 6e-4, -2e-4, 0.03, 1.26, 0.75, 0.14}},
          {fisheye, {0.05, -0.02, 0.01, -0.003}},
          {fisheye, {-0.03, 0.01, -0.008, 0.001}}};
}

TEST(LensDistortion, UndistortingInvertsProjectionAndReturnsThePointOnTheFirstFold) {
  for (const LensDistortion& lens : lenses())
    for (double x = -0.75; x <= 0.75; x += 0.125)
      for (double y = -0.5; y <= 0.5; y += 0.125) {
        const Vector2d ray(0.8 * x, 0.9 * y);
        const auto ideal = lens.undistort({x, y}), back = lens.undistort(lens.distort(ray));
        ASSERT_TRUE(ideal && back) << lens.coefficients[0] << " at " << x << ", " << y;
        // A millionth of a pixel for a focal length of 1000 pixels.
        EXPECT_LE((lens.distort(*ideal) - Vector2d(x, y)).norm(), 1e-9);
        EXPECT_LE((*back - ray).norm(), 1e-9);
      }
}

TEST(LensDistortion, EndsWhereItFoldsBack) {
  // r' = r - 0.4 r^3 increases up to r = sqrt(1 / 1.2), where r' = 2/3 r.
  const LensDistortion barrel{DistortionModel::opencv, {-0.4, 0.0, 0.0, 0.0}};
  const double edge = 2.0 / 3.0 / std::sqrt(1.2);
  EXPECT_TRUE(barrel.undistort({0.999 * edge, 0.0}));
  EXPECT_FALSE(barrel.undistort({1.001 * edge, 0.0}));
  EXPECT_NEAR(barrel.reach(Vector2d(0.6, 0.8) * 2.0 * edge), 0.5, 1e-4);
  EXPECT_EQ(barrel.reach({0.9 * edge, 0.0}), 1.0);
  // Higher terms make r' increase again; points there are on another fold.
  const LensDistortion wave{DistortionModel::opencv, {-0.4, 0.0, 0.0, 0.0, 0.02}};
  EXPECT_FALSE(wave.undistort({1.2, 0.0}));
}

TEST(LensDistortion, AFisheyeEndsAtARightAngle) {
  const LensDistortion fisheye{DistortionModel::fisheye, {0.0, 0.0, 0.0, 0.0}};
  const auto steep = fisheye.undistort({1.5, 0.0});
  ASSERT_TRUE(steep);
  EXPECT_NEAR(steep->x(), std::tan(1.5), 1e-9);
  EXPECT_FALSE(fisheye.undistort({1.6, 0.0}));
  EXPECT_NEAR(fisheye.reach({0.0, std::numbers::pi}), 0.5, 1e-12);
}

TEST(LensDistortion, HasTheTangentialTermOfItsModel) {
  const double x = 0.3, y = -0.2, q = x * x + y * y, p1 = 0.01, p2 = -0.02;
  for (const auto& [model, cross] :
       {std::pair(DistortionModel::opencv, 2.0), std::pair(DistortionModel::rational_6kt, 1.0)}) {
    const Vector2d image = LensDistortion{model, {0, 0, p1, p2, 0, 0, 0, 0}}.distort({x, y});
    EXPECT_NEAR(image.x(), x + cross * p1 * x * y + p2 * (q + 2 * x * x), 1e-15);
    EXPECT_NEAR(image.y(), y + p1 * (q + 2 * y * y) + cross * p2 * x * y, 1e-15);
  }
}

TEST(LensDistortion, EndsAtItsRadiusAndFoldsOnlyWithinIt) {
  LensDistortion barrel{DistortionModel::opencv, {-0.4, 0.0, 0.0, 0.0}, 0.5};  // folds at 0.913
  const double edge = 0.5 * (1.0 - 0.4 * 0.25);
  EXPECT_TRUE(barrel.undistort({0.999 * edge, 0.0}));
  EXPECT_FALSE(barrel.undistort({1.001 * edge, 0.0}));
  EXPECT_EQ(barrel.reach({2.0, 0.0}), 1.0);
  barrel.max_radius = 1.0;
  EXPECT_LT(barrel.reach({2.0, 0.0}), 1.0);
}

TEST(LensDistortion, ReportsTheFieldItsValueAndTheRule) {
  const auto message = [](LensDistortion lens) -> std::string {
    try {
      lens.validate("lens.distortion");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const LensDistortion& lens : lenses()) EXPECT_EQ(message(lens), "accepted");
  EXPECT_EQ(message({DistortionModel::opencv, {0.1, 0.2}}),
            "lens.distortion = [0.1, 0.2]; must be 4, 5, 8, 12 or 14 numbers: k1 k2 p1 p2 [k3 [k4 "
            "k5 k6 [s1 s2 s3 s4 [0 0]]]]");
  EXPECT_EQ(message({DistortionModel::opencv, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.01}}),
            "lens.distortion = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.01]; must have a tilt of "
            "0 (the last two numbers): tilted sensors are not supported");
  EXPECT_EQ(message({DistortionModel::rational_6kt, {0, 0, 0, 0}}),
            "lens.distortion = [0, 0, 0, 0]; must be 8 numbers: k1 k2 p1 p2 k3 k4 k5 k6");
  EXPECT_EQ(
      message({DistortionModel::fisheye, {0, 0, 0, 0, 0}}),
      "lens.distortion = [0, 0, 0, 0, 0]; must be the 4 numbers of a fisheye model: k1 k2 k3 k4");
  EXPECT_EQ(message({DistortionModel::opencv, {0, NAN, 0, 0}}),
            "lens.distortion = [0, nan, 0, 0]; must be finite");
}

}  // namespace
}  // namespace tofsmith

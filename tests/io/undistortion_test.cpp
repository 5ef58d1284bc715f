// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/undistortion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tofsmith {
namespace {

PinholeView view_with(double k1) {
  return {.fx_px = 60.0,
          .fy_px = 62.0,
          .cx_px = 39.0,
          .cy_px = 30.5,
          .width = 80,
          .height = 60,
          .distortion = LensDistortion{DistortionModel::opencv, {k1, 0.0, 1e-3, -1e-3}}};
}

TEST(Undistortion, UsesTheNearestPixelOfTheRay) {
  const PinholeView view = view_with(-0.2);
  Image<std::int32_t> places(view.height, view.width);
  for (std::size_t i = 0; i < places.size(); ++i) places.pixels[i] = static_cast<std::int32_t>(i);
  Undistortion(view).apply(places, std::int32_t{-1});
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column) {
      const auto seen_at = view.pixel_of(view.ideal().ray(row, column));
      ASSERT_TRUE(seen_at);
      const int source = places(row, column);
      ASSERT_GE(source, 0);  // a barrel lens has a wider view than the pinhole
      EXPECT_LE(std::abs(source % view.width - seen_at->x()), 0.5);
      EXPECT_LE(std::abs(source / view.width - seen_at->y()), 0.5);
    }
}

TEST(Undistortion, APlanePerpendicularToTheAxisStaysFlat) {
  const PinholeView view = view_with(-0.2);
  const Undistortion undistortion(view);
  Image<float> depth_m = radial_from_z(Image<float>(view.height, view.width, 2.0f), view);
  undistortion.apply(depth_m, NAN);
  undistortion.turn_radial(depth_m);
  for (const float z_m : z_from_radial(depth_m, view.ideal()).pixels) EXPECT_NEAR(z_m, 2.0, 1e-6);
}

TEST(Undistortion, PixelsOutsideTheLensViewAreEmpty) {
  const PinholeView view = view_with(0.3);  // a pincushion lens has a narrower view
  Image<float> plane(view.height, view.width, 1.0f);
  Undistortion(view).apply(plane, NAN);
  EXPECT_TRUE(std::isnan(plane(0, 0)));
  EXPECT_EQ(plane(30, 39), 1.0f);
}

TEST(Undistortion, WithoutDistortionNothingChanges) {
  PinholeView view = view_with(0.0);
  view.distortion->coefficients = {0.0, 0.0, 0.0, 0.0};
  Image<float> depth_m(view.height, view.width);
  for (std::size_t i = 0; i < depth_m.size(); ++i) depth_m.pixels[i] = 1.0f + static_cast<float>(i);
  const Image<float> before = depth_m;
  const Undistortion undistortion(view);
  undistortion.apply(depth_m, NAN);
  undistortion.turn_radial(depth_m);
  EXPECT_EQ(depth_m.pixels, before.pixels);
}

}  // namespace
}  // namespace tofsmith

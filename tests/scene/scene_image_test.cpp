// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tofsmith {
namespace {

TEST(SceneImage, ReportsThePixelTheValueAndTheRule) {
  const auto message = [](auto change) -> std::string {
    SceneImage scene(3, 4);
    change(scene);
    try {
      scene.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](SceneImage&) {}), "accepted");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo(2, 1) = -0.5f; }),
            "albedo(2, 1) = -0.5; must be in [0, 1]");
  EXPECT_EQ(message([](SceneImage& s) { s.cosine(0, 3) = NAN; }),
            "cosine(0, 3) = nan; must be in [0, 1]");
  EXPECT_EQ(message([](SceneImage& s) { s.depth_m(1, 0) = 0.0f; }),
            "depth_m(1, 0) = 0; must be finite and > 0, or NaN for pixels without return");
  EXPECT_EQ(message([](SceneImage& s) { s.depth_m(1, 0) = INFINITY; }),
            "depth_m(1, 0) = inf; must be finite and > 0, or NaN for pixels without return");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo = Image<float>(3, 5); }),
            "albedo size = 3 x 5 with 15 pixels; must equal depth_m's, 3 x 4");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo.pixels.pop_back(); }),
            "albedo size = 3 x 4 with 11 pixels; must equal depth_m's, 3 x 4");
  EXPECT_EQ(message([](SceneImage& s) { s.ambient_scale = Image<float>(3, 4, -1.0f); }),
            "ambient_scale(0, 0) = -1; must be finite and >= 0");
  EXPECT_EQ(message([](SceneImage& s) { s = SceneImage(); }),
            "depth_m size = 0 x 0; must have at least one pixel");
}

TEST(PinholeView, EdgesOfTheImageSpanTheAngle) {
  const PinholeView view = PinholeView::centred(320, 240, std::numbers::pi / 3);
  const Eigen::Vector3d corner_ray((-0.5 - view.cx_px) / view.fx_px, 0, 1);
  EXPECT_NEAR(std::atan2(-corner_ray.x(), 1.0), std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(view.ray(100, 7).norm(), 1.0, 1e-15);
}

TEST(PinholeView, RadialDistanceAndZDepthAreInverse) {
  const PinholeView view = PinholeView::centred(17, 13, 1.4);
  Image<float> z(13, 17, 2.0f);
  z(3, 4) = NAN;
  const Image<float> radial = radial_from_z(z, view);
  const Image<float> back = z_from_radial(radial, view);
  for (int row = 0; row < 13; ++row) {
    for (int column = 0; column < 17; ++column) {
      if (row == 3 && column == 4) {
        EXPECT_TRUE(std::isnan(radial(row, column)));
        continue;
      }
      EXPECT_NEAR(radial(row, column), 2.0 / view.ray(row, column).z(), 1e-6);
      EXPECT_NEAR(back(row, column), 2.0, 1e-6);
    }
  }
  EXPECT_THROW(radial_from_z(Image<float>(5, 5), view), std::invalid_argument);
  EXPECT_THROW(PinholeView{}.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

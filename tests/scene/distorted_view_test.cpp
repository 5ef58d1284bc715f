// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {
namespace {

PinholeView distorted(LensDistortion distortion) {
  return {.fx_px = 60.0,
          .fy_px = 62.0,
          .cx_px = 39.0,
          .cy_px = 30.5,
          .width = 80,
          .height = 60,
          .distortion = std::move(distortion)};
}

std::vector<PinholeView> views() {
  return {distorted({DistortionModel::opencv, {-0.2, 0.04, 1e-3, -2e-3, -0.004}}),
          distorted({DistortionModel::fisheye, {0.05, -0.01, 0.004, -0.001}})};
}

TEST(DistortedView, ProjectsAPointToThePixelThatSeesIt) {
  for (const PinholeView& view : views())
    for (int row = 0; row < view.height; row += 7)
      for (int column = 0; column < view.width; column += 7) {
        const auto pixel = view.pixel_of(3.0 * view.ray(row, column));
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x(), column, 1e-6);
        EXPECT_NEAR(pixel->y(), row, 1e-6);
      }
  EXPECT_FALSE(views()[0].pixel_of({0, 0, -1}));
}

TEST(DistortedView, CachedRaysEqualThoseOfTheView) {
  for (const PinholeView& view : views()) {
    const PixelRays rays(view);
    for (int row = 0; row < view.height; row += 5)
      for (int column = 0; column < view.width; column += 5) {
        EXPECT_EQ(rays.ray(row, column), view.ray(row, column));
        EXPECT_EQ(rays.radial_per_z(row, column), view.radial_per_z(row, column));
      }
    EXPECT_GT(rays.bytes(), 0u);
    EXPECT_EQ(PixelRays(view.ideal()).bytes(), 0u);
  }
}

TEST(DistortedView, APlaneGivesCoplanarPoints) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, -1.0).normalized();
  const Eigen::Vector3d point_m(0.0, 0.0, 2.0);
  for (const PinholeView& view : views()) {
    const SceneImage seen = ray_cast(std::vector<Shape>{Plane{point_m, normal, {}}}, view);
    for (int row = 0; row < view.height; ++row)
      for (int column = 0; column < view.width; ++column) {
        const Eigen::Vector3d at_m =
            view.ray(row, column) * static_cast<double>(seen.depth_m(row, column));
        EXPECT_NEAR(normal.dot(at_m - point_m), 0.0, 1e-6);
      }
    // The depth of a plane perpendicular to the axis is constant.
    const SceneImage across =
        ray_cast(std::vector<Shape>{Plane{point_m, -Eigen::Vector3d::UnitZ(), {}}}, view);
    for (const float z_m : z_from_radial(across.depth_m, view).pixels) EXPECT_NEAR(z_m, 2.0, 1e-6);
  }
}

TEST(DistortedView, IsInvalidIfItFoldsBackInsideTheImage) {
  PinholeView view = distorted({DistortionModel::opencv, {-0.6, 0.0, 0.0, 0.0}});
  try {
    view.validate();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "lens.distortion = [-0.6, 0, 0, 0]; must not fold back inside the image: it does so "
              "30.18 px "
              "from the axis, towards pixel (row 0, column 0), which is 49.51 px from the axis");
  }
  view.fx_px = view.fy_px = 120.0;  // a narrower view ends before the fold
  EXPECT_NO_THROW(view.validate());
  view = distorted({DistortionModel::fisheye, {0, 0, 0, 0}});
  view.fx_px = view.fy_px = 25.0;
  EXPECT_THROW(view.validate(), std::invalid_argument);
}

TEST(DistortedView, PartsOfPixelsAreCentredOnThem) {
  for (const PinholeView& view : views()) {
    const PinholeView parts = view.divided(3);
    EXPECT_LE((parts.ray(3 * 20 + 1, 3 * 70 + 1) - view.ray(20, 70)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace tofsmith

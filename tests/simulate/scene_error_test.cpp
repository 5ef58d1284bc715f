// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tofsmith {
namespace {

constexpr float nan_m = std::numeric_limits<float>::quiet_NaN();

SceneImage scene_of(std::vector<float> depths_m) {
  SceneImage scene(1, static_cast<int>(depths_m.size()));
  scene.depth_m.pixels = std::move(depths_m);
  return scene;
}

Image<float> image_of(std::vector<float> values) {
  Image<float> image(1, static_cast<int>(values.size()));
  image.pixels = std::move(values);
  return image;
}

const Camera& camera() {
  static const Camera paper = built_in_camera("paper-30x");  // range 9.993 m
  return paper;
}

TEST(SceneError, CountsDecodedAndOtherPixels) {
  // Errors 0.1 and 0.2, one outlier of 1, one pixel without depth; the last has no true depth.
  const SceneImage scene = scene_of({2.0f, 3.0f, 4.0f, 5.0f, nan_m});
  const Image<float> decoded = image_of({2.1f, 2.8f, 5.0f, nan_m, 7.0f});
  const SceneError error = scene_error(decoded, scene, camera(), DepthErrorKind::circular);
  EXPECT_EQ(error.pixels, 4);
  EXPECT_NEAR(error.mean_m, 1.3 / 3, 1e-6);
  EXPECT_NEAR(error.median_m, 0.2, 1e-6);
  EXPECT_DOUBLE_EQ(error.outlier_rate, 0.5);
  EXPECT_DOUBLE_EQ(error.decoded_share, 0.75);
  EXPECT_EQ(error.outlier_threshold_m, default_outlier_threshold_m);
}

TEST(SceneError, WrapsTrueDepthAndTheCircularDifference) {
  const double range_m = camera().range_m();
  const SceneImage scene = scene_of({static_cast<float>(range_m + 2.0), 0.1f});
  const Image<float> decoded = image_of({2.5f, static_cast<float>(range_m - 0.1)});
  EXPECT_NEAR(wrapped_depth_m(scene, camera()).pixels[0], 2.0, 1e-5);
  const auto circular = depth_difference_m(decoded, scene, camera(), DepthErrorKind::circular);
  EXPECT_NEAR(circular.pixels[0], 0.5, 1e-5);
  EXPECT_NEAR(circular.pixels[1], -0.2, 1e-5);
  const auto linear = depth_difference_m(decoded, scene, camera(), DepthErrorKind::linear);
  EXPECT_NEAR(linear.pixels[1], range_m - 0.2, 1e-5);
}

TEST(SceneError, OfAnEmptySceneIsZero) {
  const SceneError nothing =
      scene_error(image_of({1.0f}), scene_of({nan_m}), camera(), DepthErrorKind::circular);
  EXPECT_EQ(nothing.pixels, 0);
  EXPECT_EQ(nothing.mean_m, 0.0);
  const SceneError blind =
      scene_error(image_of({nan_m}), scene_of({1.0f}), camera(), DepthErrorKind::circular);
  EXPECT_EQ(blind.outlier_rate, 1.0);
  EXPECT_EQ(blind.decoded_share, 0.0);
}

TEST(SceneError, RejectsImagesOfAnotherSize) {
  EXPECT_THROW(
      scene_error(image_of({1.0f, 2.0f}), scene_of({1.0f}), camera(), DepthErrorKind::circular),
      std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

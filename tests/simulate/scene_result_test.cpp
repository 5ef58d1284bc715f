// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr float nan_m = std::numeric_limits<float>::quiet_NaN();

SceneResult small_scene() {
  SceneResult scene{.name = "ramp", .truth = SceneImage(6, 8)};
  for (std::size_t i = 0; i < scene.truth.depth_m.size(); ++i)
    scene.truth.depth_m.pixels[i] = 1.0f + 0.1f * static_cast<float>(i);
  scene.truth.depth_m.pixels[5] = nan_m;
  return scene;
}

TEST(CaptureAndDecode, FillsOneDecodingPerLightAndCodeForAnyNumberOfThreads) {
  const Camera camera = built_in_camera("paper-30x");
  const std::vector<CodeSet> codes{build_family("sinusoid-k4", camera),
                                   build_family("hamiltonian-k3", camera)};
  const std::vector<NamedLight> lights{{"low", {1e5, 1e3}}, {"high", {1e9, 1e3}}};
  SceneResult one = small_scene(), two = small_scene();
  {
    const ThreadLimit limit(1);
    capture_and_decode(one, codes, camera, lights, 7);
  }
  {
    const ThreadLimit limit(2);
    capture_and_decode(two, codes, camera, lights, 7);
  }
  ASSERT_EQ(one.captures.size(), 2u);
  for (std::size_t l = 0; l < 2; ++l) {
    EXPECT_EQ(one.captures[l].light, lights[l].name);
    EXPECT_EQ(one.captures[l].point, lights[l].point);
    ASSERT_EQ(one.captures[l].decodings.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
      const SceneDecoding& d = one.captures[l].decodings[c];
      EXPECT_EQ(d.code, codes[c].name());
      EXPECT_EQ(d.error.pixels, 47);
      ASSERT_EQ(d.depth_m.size(), 48u);
      for (std::size_t i = 0; i < 48; ++i) {
        const float a = d.depth_m.pixels[i], b = two.captures[l].decodings[c].depth_m.pixels[i];
        EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i;
      }
    }
  }
  for (const SceneDecoding& d : one.captures[1].decodings)
    EXPECT_LT(d.error.mean_m, 0.01) << "plenty of light";
}

TEST(CaptureAndDecode, AlsoFiltersTheSameRawValues) {
  const Camera camera = built_in_camera("paper-30x");
  const std::vector<CodeSet> codes{build_family("hamiltonian-k4", camera)};
  const std::vector<NamedLight> lights{{"dim", {1e5, 1e3}}};
  SceneResult plain{.name = "wall", .truth = SceneImage(30, 40)};
  plain.truth.depth_m = Image<float>(30, 40, 2.0f);
  SceneResult both = plain;
  capture_and_decode(plain, codes, camera, lights, 7);
  capture_and_decode(both, codes, camera, lights, 7, FilterOptions{});
  const SceneDecoding &alone = plain.captures[0].decodings[0], &d = both.captures[0].decodings[0];
  EXPECT_FALSE(alone.filtered);
  EXPECT_EQ(alone.depth_m.pixels, d.depth_m.pixels);
  ASSERT_TRUE(d.filtered);
  EXPECT_EQ(d.filtered->averaged.size(), 1200u);
  EXPECT_LT(d.filtered->error.mean_m, 0.5 * d.error.mean_m);
}

TEST(CaptureAndDecode, StopsOnRequest) {
  const Camera camera = built_in_camera("paper-30x");
  SceneResult scene = small_scene();
  EXPECT_THROW(capture_and_decode(scene, std::vector{build_family("sinusoid-k4", camera)}, camera,
                                  std::vector<NamedLight>{{"low", {1e4, 1e3}}}, 1, {},
                                  [](double, std::string_view) { return false; }),
               Interrupted);
}

TEST(MedianDepth, IgnoresPixelsWithoutReturn) {
  SceneImage scene(1, 3);
  EXPECT_EQ(median_depth_m(scene), 1.0);
  scene.depth_m.pixels = {2.0f, nan_m, 3.0f};
  EXPECT_EQ(median_depth_m(scene), 2.5);
}

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

TEST(SceneExtent, CountsReturnsAndWraps) {
  const Camera camera = built_in_camera("paper-10f0");  // 9.99 m
  SceneImage scene(1, 5);                               // no return
  scene.depth_m.pixels[1] = 2.0f;
  scene.depth_m.pixels[2] = 10.5f;
  scene.depth_m.pixels[4] = 9.0f;
  const SceneExtent extent = scene_extent(scene, camera);
  EXPECT_EQ(extent.pixels, 5);
  EXPECT_EQ(extent.returns, 3);
  EXPECT_EQ(extent.beyond_range, 1);
  EXPECT_DOUBLE_EQ(extent.no_return_share(), 0.4);
  EXPECT_DOUBLE_EQ(extent.beyond_range_share(), 1.0 / 3.0);
  EXPECT_EQ(extent.nearest_m, 2.0);
  EXPECT_EQ(extent.median_m, 9.0);
  EXPECT_EQ(extent.farthest_m, 10.5);
  EXPECT_EQ(beyond_range(scene, camera).pixels, (std::vector<std::uint8_t>{0, 0, 1, 0, 0}));
}

TEST(SceneExtent, OfAnEmptySceneIsZero) {
  const SceneExtent extent = scene_extent(SceneImage(2, 2), built_in_camera("paper-10f0"));
  EXPECT_EQ(extent.returns, 0);
  EXPECT_EQ(extent.farthest_m, 0.0);
  EXPECT_EQ(extent.no_return_share(), 1.0);
  EXPECT_EQ(extent.beyond_range_share(), 0.0);
}

}  // namespace

}  // namespace tofsmith

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

SceneResult small_scene() {
  SceneResult scene{.name = "ramp", .truth = SceneImage(6, 8)};
  for (std::size_t i = 0; i < scene.truth.depth_m.size(); ++i)
    scene.truth.depth_m.pixels[i] = 1.0f + 0.1f * static_cast<float>(i);
  scene.truth.depth_m.pixels[5] = std::numeric_limits<float>::quiet_NaN();
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
  scene.depth_m.pixels = {2.0f, std::numeric_limits<float>::quiet_NaN(), 3.0f};
  EXPECT_EQ(median_depth_m(scene), 2.5);
}

}  // namespace
}  // namespace tofsmith

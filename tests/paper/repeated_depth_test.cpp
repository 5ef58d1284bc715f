// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/repeated_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "table_top_image.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(RepeatedDepth, IsTheStatisticsOfDecodedCaptures) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  SceneImage scene = table_top_image(12, 10);
  scene.depth_m(3, 4) = nan;
  const CaptureOptions options{.signal_e_per_s = 3e4, .ambient_e_per_s = 1e3, .frames = 7};
  const RepeatedDepth repeated = repeated_depth(scene, code, camera, options);

  const RawFrames raw = capture(scene, code, camera, options);
  const ForwardModel model(code, camera);
  const Decoder decoder(make_decoding_table(model, camera));
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 12; ++column) {
      if (std::isnan(scene.depth_m(row, column))) {
        EXPECT_TRUE(std::isnan(repeated.mean_m(row, column)));
        EXPECT_TRUE(std::isnan(repeated.outlier_rate(row, column)));
        continue;
      }
      RunningStatistics depth, error;
      double outliers = 0;
      for (int f = 0; f < 7; ++f) {
        double bin = 0;
        decoder.decode_depth_bins(raw.frame(f) + 4 * (row * 12 + column), 1, &bin);
        depth.add(bin * camera.bin_m());
        error.add(std::abs(bin * camera.bin_m() - scene.depth_m(row, column)));
        outliers += std::abs(bin * camera.bin_m() - scene.depth_m(row, column)) > 0.3;
      }
      EXPECT_NEAR(repeated.mean_m(row, column), depth.mean(), 1e-5);
      EXPECT_NEAR(repeated.standard_deviation_m(row, column), std::sqrt(depth.variance()), 1e-5);
      EXPECT_NEAR(repeated.mean_abs_error_m(row, column), error.mean(), 1e-5);
      EXPECT_NEAR(repeated.outlier_rate(row, column), outliers / 7, 1e-6);
    }
}

TEST(RepeatedDepth, AReferenceReplacesTheTruth) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  SceneImage scene(2, 3);
  for (float& depth : scene.depth_m.pixels) depth = 0.5f;
  RepeatedDepthOptions options;
  options.reference_m = Image<float>(2, 3, 2.5f);
  options.reference_m(1, 1) = nan;
  const RepeatedDepth repeated =
      repeated_depth(scene, code, camera, {.signal_e_per_s = 1e6, .frames = 4}, options);
  EXPECT_NEAR(repeated.mean_abs_error_m(0, 0), 2.0, 0.2);
  EXPECT_EQ(repeated.outlier_rate(0, 0), 1.0f);
  EXPECT_NEAR(repeated.mean_m(1, 1), 0.5, 0.2);
  EXPECT_TRUE(std::isnan(repeated.mean_abs_error_m(1, 1)));
}

TEST(RepeatedDepth, SameBitsForAnyNumberOfThreads) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const SceneImage scene = table_top_image(16, 12);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return repeated_depth(scene, code, camera, {.frames = 3}).mean_m.pixels;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(RepeatedDepth, RefusesNonsense) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  SceneImage scene(2, 3);
  for (float& depth : scene.depth_m.pixels) depth = 0.5f;
  EXPECT_THROW(repeated_depth(scene, code, camera, {.frames = 0}), std::invalid_argument);
  EXPECT_THROW(repeated_depth(scene, code, camera, {}, {.reference_m = Image<float>(3, 3, 1.0f)}),
               std::invalid_argument);
  EXPECT_THROW(repeated_depth(scene, code, camera, {}, {.outlier_threshold_m = -1}),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

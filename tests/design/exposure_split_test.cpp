// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_split.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace tofsmith {
namespace {

TEST(ExposureSplit, GivesTheExposuresThatMeasureDepthMoreTime) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e6};
  camera.operating.ambient_e_per_s = {1e5};
  camera.operating.error = DepthErrorKind::circular;
  DesignOptions options;
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  const CodeSet split = with_split_exposures(even, camera, options);
  ASSERT_EQ(split.exposure_shares().size(), 8u);
  const std::vector<double>& shares = split.exposure_shares();
  EXPECT_LT(std::accumulate(shares.begin(), shares.begin() + 4, 0.0), 0.4);
  const EvaluateOptions fresh{.trials = 20000, .seed = 77, .bounds = false};
  EXPECT_LT(evaluate(split, camera, fresh).circular.geometric_mean_m.value,
            0.93 * evaluate(even, camera, fresh).circular.geometric_mean_m.value);
}

TEST(ExposureSplit, LeavesCamerasThatListTimesAlone) {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.each_s = {0.1, 0.1, 0.1, 0.1};
  DesignResult result;
  result.candidates.push_back({.code = build_family("square-k4", camera), .method = "optimize"});
  add_split_exposures(camera, {}, result, {});
  EXPECT_EQ(result.candidates.size(), 1u);
}

}  // namespace
}  // namespace tofsmith

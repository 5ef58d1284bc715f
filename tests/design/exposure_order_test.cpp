// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "same_code.hpp"
#include "small_design.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/motion_error.hpp"

namespace tofsmith {
namespace {

Camera moving_camera() {
  Camera camera = small_camera("paper-10f0", DepthErrorKind::circular);
  camera.exposure_s.total_s = 20e-3;
  camera.operating.velocity_m_per_s = 1.0;
  return camera;
}

double rms_bias_m(const CodeSet& code, const Camera& camera) {
  return MotionBias(ForwardModel(code, camera), camera).rms_m(exposure_shifts_m(code, camera, 1.0));
}

TEST(ExposureOrder, IsTheBestOfAll) {
  const Camera camera = moving_camera();
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "square-k4"}) {
    const CodeSet code = build_family(name, camera);
    const ExposureOrder found = best_exposure_order(code, camera, 1.0);
    EXPECT_NEAR(found.given_rms_bias_m, rms_bias_m(code, camera), 1e-12) << name;
    EXPECT_NEAR(found.rms_bias_m, rms_bias_m(code.with_exposure_order(found.order), camera), 1e-9);
    std::vector<int> order{0, 1, 2, 3};
    do {
      EXPECT_LE(found.rms_bias_m, rms_bias_m(code.with_exposure_order(order), camera) + 1e-8);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ExposureOrder, TakesUnequalExposureTimesIntoAccount) {
  const Camera camera = moving_camera();
  const CodeSet code =
      build_family("hamiltonian-k4", camera).with_exposure_shares({0.1, 0.4, 0.3, 0.2});
  const ExposureOrder found = best_exposure_order(code, camera, 1.0);
  EXPECT_NEAR(found.rms_bias_m, rms_bias_m(code.with_exposure_order(found.order), camera), 1e-9);
  EXPECT_LE(found.rms_bias_m, found.given_rms_bias_m);
}

TEST(ExposureOrder, KeepsTheExposuresOfAFrequencyTogether) {
  const Camera camera = moving_camera();
  for (const char* name : {"multifrequency-1x4-7x4", "multifrequency-1x5-7x5"}) {
    const CodeSet code = build_family(name, camera);
    const ExposureOrder found = best_exposure_order(code, camera, 1.0);
    EXPECT_EQ(code.with_exposure_order(found.order).frequency_starts().size(), 2u) << name;
    EXPECT_LT(found.rms_bias_m, found.given_rms_bias_m) << name;
  }
}

TEST(ExposureOrder, IsKeptIfTheCameraListsValuesForExposures) {
  Camera camera = moving_camera();
  camera.exposure_s.each_s = {5e-3, 5e-3, 5e-3, 5e-3};
  const CodeSet code = build_family("sinusoid-k4", camera);
  EXPECT_EQ(best_exposure_order(code, camera, 1.0).order, (std::vector{0, 1, 2, 3}));
}

TEST(ExposureOrder, OfCandidatesIsChosenForTheVelocityOfTheCamera) {
  const Camera camera = moving_camera();
  const CodeSet code = build_family("sinusoid-k4", camera);
  const DesignOptions options = small_options();
  const DesignResult moving = judge(camera, {{.code = code, .method = "family"}}, options);
  const Candidate& winner = moving.winner();
  ASSERT_TRUE(winner.exposure_order);
  EXPECT_EQ(winner.exposure_order->order, (std::vector{0, 1, 3, 2}));
  EXPECT_LT(rms_bias_m(winner.code, camera), 1e-6);
  EXPECT_EQ(winner.code.name(), code.name());
  EXPECT_NE(moving.explanation.back().find("reordered to 0, 1, 3, 2"), std::string::npos);

  Camera still = camera;
  still.operating.velocity_m_per_s.reset();
  const DesignResult same = judge(still, {{.code = code, .method = "family"}}, options);
  EXPECT_FALSE(same.winner().exposure_order);
  const Estimate &moved = winner.error.circular.geometric_mean_m,
                 &given = same.winner().error.circular.geometric_mean_m;
  EXPECT_NEAR(moved.value, given.value,
              4.0 * std::hypot(moved.standard_error, given.standard_error));
}

TEST(ExposureOrder, AlsoAppliesToTargetsAndReportsOfMeasurements) {
  Camera camera = moving_camera();
  camera.sensor.taps = 2;
  Candidate candidate{.code = build_family("sinusoid-k4", camera), .method = "factorize"};
  candidate.target.resize(1, 4);
  candidate.target << 0, 1, 2, 3;
  for (int i = 0; i < 4; ++i) candidate.per_measurement.push_back({.edges = i});
  Candidate of_taps = candidate;
  for (int i = 4; i < 8; ++i) of_taps.per_measurement.push_back({.edges = i});
  choose_exposure_order(camera, candidate);
  choose_exposure_order(camera, of_taps);
  const std::vector<int>& order = candidate.exposure_order->order;
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
  for (std::size_t e = 0; e < 4; ++e) {
    EXPECT_EQ(candidate.target(0, static_cast<Eigen::Index>(e)), order[e]);
    EXPECT_EQ(candidate.per_measurement[e].edges, order[e]);
    EXPECT_EQ(of_taps.per_measurement[2 * e].edges, 2 * order[e]);
    EXPECT_EQ(of_taps.per_measurement[2 * e + 1].edges, 2 * order[e] + 1);
  }
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_design.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

DesignOptions quick(DesignMethod method, std::vector<int> exposures) {
  DesignOptions options = small_options(std::move(exposures));
  options.method = method;
  options.baselines = {"square-k4", "hamiltonian-k4"};
  options.optimize.samples = 60;
  options.optimize.starts = 2;
  options.optimize.steps_per_start = 20;
  options.optimize.hops = 1;
  options.optimize.steps_per_hop = 20;
  options.optimize.refinement_steps = 20;
  options.optimize.polish_steps = 10;
  options.optimize.pool_trials = 2000;
  return options;
}

Camera clocked() {
  Camera camera = built_in_camera("exclusive-3tap-9chip");
  camera.sensor.shortest_pulse_s = 15e-9;
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1.7e7};
  camera.operating.ambient_e_per_s = {0.0};
  return camera;
}

TEST(DesignMethods, BestTriesEveryMethodAndPicksTheLowestError) {
  const Camera camera = small_camera("paper-5f0", DepthErrorKind::circular);
  const DesignResult result = design(camera, quick(DesignMethod::best, {3, 4}));
  for (const char* name : {"square-k4", "hamiltonian-k3-naive", "hamiltonian-k3-factorized",
                           "optimized-k3", "optimized-k4"})
    ASSERT_NE(result.find(name), nullptr) << name;
  for (const Candidate& c : result.candidates)
    EXPECT_LE(result.winner().error.circular.geometric_mean_m.value,
              c.error.circular.geometric_mean_m.value)
        << c.code.name();
  const Candidate& optimized = *result.find("optimized-k4");
  EXPECT_EQ(optimized.method, "optimize");
  EXPECT_EQ(optimized.code.exposures(), 4);
  EXPECT_EQ(optimized.code.provenance.method, "optimize");
  ASSERT_TRUE(optimized.search);
  EXPECT_FALSE(optimized.search->proved);
  EXPECT_FALSE(optimized.search->steps.empty());
  EXPECT_EQ(optimized.per_measurement.size(), 4u);
}

TEST(DesignMethods, SearchesOnTheChipClockWithProof) {
  DesignOptions options = quick(DesignMethod::search, {1});
  const DesignResult result = design(clocked(), options);
  const Candidate* searched = result.find("searched-k1");
  ASSERT_NE(searched, nullptr);
  EXPECT_EQ(searched->method, "search");
  ASSERT_TRUE(searched->search);
  EXPECT_TRUE(searched->search->proved);
  EXPECT_THAT(searched->message, HasSubstr("proven optimal"));
  EXPECT_EQ(searched->code.measurements(), 3);
  EXPECT_NE(result.find("three-phase-square"), nullptr) << "what it has to beat";
  EXPECT_EQ(result.find("coprime-three-phase"), nullptr) << "its pulses are shorter than a chip";
  EXPECT_THAT(result.left_out, Contains(HasSubstr("coprime-three-phase: has pulses or gaps")));
}

TEST(DesignMethods, UnsuitableMethodsAreRejectedIfRequestedAndNotedOtherwise) {
  Camera camera = small_camera("paper-30x");  // no band limit, no shortest pulse
  try {
    design(camera, quick(DesignMethod::optimize, {3}));
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("sensor.shortest_pulse_s"), HasSubstr("try ")));
  }
  const DesignResult result = design(camera, quick(DesignMethod::best, {3}));
  EXPECT_THAT(result.left_out, Contains(HasSubstr("optimize: sensor.shortest_pulse_s")));
  EXPECT_NE(result.find("hamiltonian-k3-factorized"), nullptr);
  EXPECT_THROW(design(camera, quick(DesignMethod::search, {1})), std::invalid_argument);
}

TEST(DesignMethods, SharedReasonsAreReportedOnce) {
  DesignOptions options = quick(DesignMethod::search, {1});
  options.baselines = {"gray-k4", "hamiltonian-k4"};
  const DesignResult result = design(clocked(), options);
  EXPECT_THAT(result.left_out,
              Contains(HasSubstr("gray-k4, hamiltonian-k4: taps = 3; this family supports")));
}

TEST(DesignMethods, RobustCodesAreChosenByTheWorstPerturbedCamera) {
  const Camera camera = small_camera("paper-5f0", DepthErrorKind::circular);
  DesignOptions options = quick(DesignMethod::optimize, {3});
  options.robust = true;
  const DesignResult result = design(camera, options);
  for (const Candidate& c : result.candidates) {
    ASSERT_TRUE(c.robustness) << c.code.name();
    EXPECT_LE(result.winner().robustness->worst_calibrated_m().value,
              c.robustness->worst_calibrated_m().value);
    EXPECT_EQ(ranking_error_m(c, camera, options), c.robustness->worst_calibrated_m().value);
  }
}

TEST(DesignMethods, TheWinnerIsEvaluatedOnPerturbedCameras) {
  const Camera camera = small_camera("paper-5f0", DepthErrorKind::circular);
  const DesignResult result = design(camera, small_options());
  for (const Candidate& c : result.candidates)
    EXPECT_EQ(c.robustness.has_value(), &c == &result.winner()) << c.code.name();
}

TEST(DesignMethods, ExplainTheWinnerInThreeSentences) {
  const Camera camera = small_camera("paper-5f0", DepthErrorKind::circular);
  const DesignResult result = design(camera, small_options());
  ASSERT_EQ(result.explanation.size(), 3u);
  EXPECT_THAT(result.explanation[0], HasSubstr(result.winner().code.name()));
  EXPECT_THAT(result.explanation[1], HasSubstr("bandwidth of 5 harmonics"));
  EXPECT_THAT(result.explanation[2], HasSubstr("Cramer-Rao"));
}

TEST(SuggestedExposures, DecreaseWithTapsAndIncreaseWithBandwidth) {
  Camera camera = built_in_camera("paper-10f0");
  const auto most = [&] { return suggested_exposures(camera, DesignMethod::optimize).back(); };
  const int narrow = most();
  camera.light.impulse_response.f_max_hz = camera.sensor.impulse_response.f_max_hz = 600e6;
  EXPECT_GT(most(), narrow);
  camera.sensor.taps = 2;
  EXPECT_LT(most(), narrow);
  camera.sensor.taps = 4;
  EXPECT_LT(most(), narrow);
  camera.exposure_s.each_s = {0.1, 0.1, 0.05};
  EXPECT_EQ(suggested_exposures(camera, DesignMethod::best), std::vector<int>{3});
}

TEST(GainOver, IsTheRatioOfChosenErrorsWithItsStandardError) {
  const DesignResult result = design(small_camera("paper-5f0"), small_options());
  EXPECT_EQ(gain_over(result, result.winner(), DepthErrorKind::linear).value, 1.0);
  for (const Candidate& c : result.candidates) {
    const Estimate gain = gain_over(result, c, DepthErrorKind::linear);
    if (c.code.exposures() == result.winner().code.exposures()) {
      EXPECT_GE(gain.value, 1.0);
    }
    EXPECT_GT(gain.standard_error, 0.0);
    EXPECT_DOUBLE_EQ(gain.value,
                     geometric_mean_error_m(c.error, DepthErrorKind::linear) /
                         geometric_mean_error_m(result.winner().error, DepthErrorKind::linear));
  }
}

}  // namespace
}  // namespace tofsmith

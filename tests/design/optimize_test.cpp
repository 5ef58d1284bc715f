// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/optimize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "same_code.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

/// One light level on a small grid: an optimization takes milliseconds.
Camera small_camera(DepthErrorKind error = DepthErrorKind::circular) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 6.0;
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = error;
  return camera;
}

OptimizeOptions small_options() {
  OptimizeOptions options;
  options.samples = 48;
  options.starts = 4;
  options.steps_per_start = 40;
  options.hops = 5;
  options.steps_per_hop = 20;
  options.refinement_steps = 60;
  options.polish_steps = 20;
  options.trials_per_step = 60;
  options.pool_trials = 1000;
  options.validation_trials = 1000;
  return options;
}

/// Shortest time between two switches [periods], round the period.
double shortest_run(const Waveform& waveform) {
  const std::vector<OnInterval>& on = waveform.on_intervals();
  double shortest = 1.0;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double next = i + 1 < on.size() ? on[i + 1].rise : on[0].rise + 1.0;
    shortest = std::min({shortest, on[i].fall - on[i].rise, next - on[i].fall});
  }
  return shortest;
}

TEST(Optimize, BeatsTheHamiltonianCodeThatItStartsFrom) {
  const Camera camera = small_camera();
  const std::vector<CodeSet> also = {build_family("hamiltonian-k4", camera)};
  const OptimizedCode found = optimize(camera, 4, small_options(), also);
  ASSERT_EQ(found.candidates.back().name, "hamiltonian-k4");
  EXPECT_LT(found.error_m.value, 0.95 * found.candidates.back().error_m.value);
  EXPECT_FALSE(found.is_given);
  EXPECT_THAT(found.message, HasSubstr("times better than hamiltonian-k4"));
  EXPECT_EQ(found.code.provenance.method, "optimize");
  // Trials that nothing was chosen by say the same.
  EvaluateOptions fresh;
  fresh.seed = 12345;
  const Estimate error_m = evaluate(found.code, camera, fresh).circular.geometric_mean_m;
  EXPECT_NEAR(error_m.value, found.error_m.value,
              5 * std::hypot(error_m.standard_error, found.error_m.standard_error));
}

TEST(Optimize, ReckonsWithSecondReturnsWhereTheCameraSaysSo) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  camera.operating.signal_e_per_s = {1e5};
  const std::vector<CodeSet> also = {build_family("hamiltonian-k5", camera)};
  const SecondReturns later{{0.2, 0.5}, {0.5, 3.0}, 0.5};
  camera.operating.multipath = later;
  const OptimizedCode found = optimize(camera, 5, small_options(), also);
  const OptimizeCandidate& given = found.candidates.back();
  ASSERT_TRUE(given.second_returns && given.second_returns->two_return);
  EXPECT_THAT(found.message, HasSubstr("behind second ones"));
  // Fresh trials: less error by what was minimized, and two returns can still be told.
  EvaluateOptions fresh;
  fresh.trials = 4000;
  fresh.seed = 12345;
  const auto chosen_by = [&](const CodeSet& code) {
    return later.weighed(evaluate(code, camera, fresh).circular.geometric_mean_m.value,
                         second_return_error(code, camera, later, fresh).circular_m.value);
  };
  EXPECT_LT(chosen_by(found.code), chosen_by(also.front()));
  EXPECT_LT(two_return_error(found.code, camera, later, fresh).circular_m.value,
            1.4 * two_return_error(also.front(), camera, later, fresh).circular_m.value);
}

TEST(Optimize, IsNeverWorseThanTheBestCodeGiven) {
  const Camera camera = small_camera(DepthErrorKind::linear);
  OptimizeOptions poor = small_options();
  poor.starts = poor.steps_per_start = 1;
  poor.hops = poor.refinement_steps = 0;
  const std::vector<CodeSet> also = {build_family("sinusoid-k3", camera),
                                     build_family("hamiltonian-k5", camera)};
  const OptimizedCode found = optimize(camera, 3, poor, also);
  for (const OptimizeCandidate& candidate : found.candidates)
    EXPECT_LE(found.error_m.value, candidate.error_m.value);
}

TEST(Optimize, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Camera camera = small_camera(DepthErrorKind::linear);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return optimize(camera, 3, small_options());
  };
  const OptimizedCode one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.error_m.value, four.error_m.value);
  for (int e = 0; e < 3; ++e) {
    EXPECT_EQ(one.code.modulation(e), four.code.modulation(e));
    EXPECT_EQ(one.code.demodulation(e), four.code.demodulation(e));
  }
  ASSERT_EQ(one.history.size(), four.history.size());
  for (std::size_t i = 0; i < one.history.size(); ++i)
    EXPECT_EQ(one.history[i].error_m, four.history[i].error_m);
}

TEST(Optimize, KeepsEveryPulseAndGapAsLongAsAsked) {
  for (const bool band_limited : {false, true}) {
    Camera camera = small_camera();
    if (!band_limited) camera.light.impulse_response = camera.sensor.impulse_response = {};
    for (const double shortest_periods : {1.0 / 45.5, 1.0 / 13.0}) {
      camera.sensor.shortest_pulse_s = shortest_periods / camera.fundamental_frequency_hz;
      const CodeSet code = optimize(camera, 3, small_options()).code;
      for (int e = 0; e < 3; ++e) {
        EXPECT_TRUE(code.modulation(e).is_binary());
        EXPECT_GE(shortest_run(code.modulation(e)), shortest_periods - 1e-9);
        EXPECT_GE(shortest_run(code.demodulation(e)), shortest_periods - 1e-9);
        EXPECT_LE(code.modulation(e).peak(), camera.light.peak_factor * (1 + 1e-9));
        EXPECT_NEAR(code.modulation(e).mean(), 1.0, 1e-9);
      }
    }
  }
}

TEST(Optimize, AsksForAShortestPulseWhereNothingElseLimitsThem) {
  Camera camera = small_camera();
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  try {
    optimize(camera, 4, small_options());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("sensor.shortest_pulse_s"));
    EXPECT_THAT(error.what(), HasSubstr("2.2e-09"));
  }
  camera.sensor.shortest_pulse_s = suggested_shortest_pulse_s(camera);
  EXPECT_NO_THROW(optimize(camera, 4, small_options()));
}

TEST(Optimize, RefusesWhatCannotBeMeasured) {
  Camera camera = small_camera();
  EXPECT_THROW(optimize(camera, 2, small_options()), std::invalid_argument);
  EXPECT_THROW(optimize(camera, 9, small_options()), std::invalid_argument);
  camera.light.peak_factor = 1.0;
  EXPECT_THROW(optimize(camera, 4, small_options()), std::invalid_argument);
  OptimizeOptions bad = small_options();
  bad.starts = 0;
  EXPECT_THROW(optimize(small_camera(), 4, bad), std::invalid_argument);
  EXPECT_THROW(optimize(std::span<const Camera>(), 4, small_options()), std::invalid_argument);
}

TEST(Optimize, TwoBucketsShareAllCharge) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  const CodeSet code = optimize(camera, 2, small_options()).code;
  EXPECT_EQ(code.measurements(), 4);
  const Eigen::MatrixXd gain = code.demodulation_samples();
  for (int e = 0; e < 2; ++e)
    EXPECT_LT((gain.col(2 * e) + gain.col(2 * e + 1)).array().abs().maxCoeff() - 1.0, 1e-9);
}

TEST(Optimize, ExclusiveTapsUseADrainOnlyWhereThereIsOne) {
  Camera camera = small_camera();
  camera.sensor.taps = 3;
  camera.sensor.modulation_contrast = 0.9;
  for (const bool drain : {true, false}) {
    camera.sensor.drain = drain;
    const CodeSet code = optimize(camera, 1, small_options()).code;
    const Eigen::VectorXd sum = code.demodulation_samples().rowwise().sum();
    EXPECT_LE(sum.maxCoeff(), 1.0 + 1e-9);
    if (!drain) {
      EXPECT_GE(sum.minCoeff(), 1.0 - 1e-9);
    }
  }
}

TEST(Optimize, DifferencesOfBucketsCancelAmbientLight) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const CodeSet code = optimize(camera, 2, small_options()).code;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(code.demodulation(i).mean(), 0.5, 1e-9);
}

TEST(Optimize, ArmsThatNeedNotSwitchPlayAnyValue) {
  Camera camera = small_camera();
  camera.light.binary = false;
  const CodeSet code = optimize(camera, 3, small_options()).code;
  EXPECT_FALSE(code.modulation(0).is_binary());
  EXPECT_TRUE(code.demodulation(0).is_binary());
  EXPECT_LE(code.peak(), camera.light.peak_factor * (1 + 1e-9));
  EXPECT_LE(code.modulation(0).mean(), 1.0 + 1e-9);
}

TEST(Optimize, JudgesByTheWorstVariant) {
  std::vector<Camera> variants(2, small_camera());
  variants[1].light.impulse_response.f_max_hz *= 0.8;
  const OptimizedCode found = optimize(variants, 3, small_options());
  EvaluateOptions fresh;
  double worst_m = 0.0;
  for (const Camera& variant : variants)
    worst_m =
        std::max(worst_m, evaluate(found.code, variant, fresh).circular.geometric_mean_m.value);
  EXPECT_NEAR(found.error_m.value, worst_m, 0.15 * worst_m);
}

TEST(Optimize, HistoryNeverRisesAndEndsEarlyWithoutGain) {
  OptimizeOptions options = small_options();
  options.hops = 40;
  options.steps_per_hop = 1;
  options.patience = 5;
  const OptimizedCode found = optimize(small_camera(), 3, options);
  for (std::size_t i = 1; i < found.history.size(); ++i)
    EXPECT_LE(found.history[i].best_error_m, found.history[i - 1].best_error_m);
  EXPECT_THAT(found.message, HasSubstr("hops ended early"));
}

TEST(Optimize, StopsWhenAsked) {
  int calls = 0;
  EXPECT_THROW(optimize(small_camera(), 3, small_options(), {},
                        [&](double fraction, std::string_view) {
                          EXPECT_GE(fraction, 0.0);
                          EXPECT_LE(fraction, 1.0);
                          return ++calls < 3;
                        }),
               Interrupted);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "design_setup.hpp"
#include "random_cameras.hpp"
#include "refusal.hpp"
#include "sanitizers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

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
  const Camera camera = coarse_camera("paper-5f0", DepthErrorKind::circular);
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
  options.baselines = {"gray-k4", "hamiltonian-k4"};
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
  EXPECT_THAT(result.left_out,
              Contains(HasSubstr("gray-k4, hamiltonian-k4: taps = 3; this family supports")))
      << "a shared reason is reported once";
}

TEST(DesignMethods, UnsuitableMethodsAreRejectedIfRequestedAndNotedOtherwise) {
  Camera camera = coarse_camera("paper-30x");  // no band limit, no shortest pulse
  EXPECT_THAT(refusal_of([&] { design(camera, quick(DesignMethod::optimize, {3})); }),
              AllOf(HasSubstr("sensor.shortest_pulse_s"), HasSubstr("try ")));
  const DesignResult result = design(camera, quick(DesignMethod::best, {3}));
  EXPECT_THAT(result.left_out, Contains(HasSubstr("optimize: sensor.shortest_pulse_s")));
  EXPECT_NE(result.find("hamiltonian-k3-factorized"), nullptr);
  EXPECT_THROW(design(camera, quick(DesignMethod::search, {1})), std::invalid_argument);
}

TEST(DesignMethods, RobustCodesAreChosenByTheWorstPerturbedCamera) {
  const Camera camera = coarse_camera("paper-5f0", DepthErrorKind::circular);
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

TEST(DesignMethods, TheWinnerIsExplainedAndEvaluatedOnPerturbedCameras) {
  const Camera camera = coarse_camera("paper-5f0", DepthErrorKind::circular);
  const DesignResult result = design(camera, small_options());
  for (const Candidate& c : result.candidates)
    EXPECT_EQ(c.robustness.has_value(), &c == &result.winner()) << c.code.name();
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
  const DesignResult result = design(coarse_camera("paper-5f0"), small_options());
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

// A larger search space or a longer search never yields a worse code.

/// An optimization for this camera takes about a second.
Camera small_camera(DepthErrorKind error, int taps) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 6.0;
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = error;
  camera.sensor.taps = taps;
  if (taps == 2) camera.sensor.readout = Readout::difference;
  return camera;
}

/// Descents of few steps, in the usual number.
DesignOptions short_descents() {
  DesignOptions options;
  options.method = DesignMethod::optimize;
  options.exposures = {4};
  options.baselines.emplace();
  options.trials = 2000;
  options.optimize.samples = 24;
  options.optimize.steps_per_start = 6;
  options.optimize.steps_per_hop = 6;
  options.optimize.polish_steps = 10;
  options.optimize.trials_per_step = 16;
  options.optimize.pool_trials = 1000;
  return options;
}

Estimate error_m(const Camera& camera, const DesignOptions& options) {
  return design(camera, options).winner().error.of(camera.operating.error).geometric_mean_m;
}

/// Winners may be evaluated with different numbers of trials.
void expect_no_worse(const Estimate& error_m, const Estimate& than_m) {
  EXPECT_LE(error_m.value,
            than_m.value + 2.0 * std::hypot(error_m.standard_error, than_m.standard_error));
}

TEST(Superset, ArbitraryWaveformsAreNoWorseThanBinaryOnes) {
  DesignOptions options = short_descents();
  options.optimize.starts = 4;
  options.optimize.hops = 5;
  options.optimize.refinement_steps = 40;
  for (const DepthErrorKind error : {DepthErrorKind::circular, DepthErrorKind::linear})
    for (const int taps : {1, 2}) {
      const Camera switching = small_camera(error, taps);
      Camera light = switching, both = switching;
      light.light.binary = both.light.binary = both.sensor.binary = false;
      const Estimate switching_m = error_m(switching, options);
      expect_no_worse(error_m(light, options), switching_m);
      expect_no_worse(error_m(both, options), switching_m);
    }
}

TEST(Superset, MoreEffortIsNeverWorse) {
  for (const int taps : {1, 2}) {
    const Camera camera = small_camera(DepthErrorKind::circular, taps);
    const Estimate usual_m = error_m(camera, short_descents());
    const Estimate twice_m = error_m(camera, with_effort(short_descents(), 2.0));
    expect_no_worse(twice_m, usual_m);
    expect_no_worse(error_m(camera, with_effort(short_descents(), 4.0)), twice_m);
  }
}

TEST(Superset, TwiceTheEffortIncludesTheCodesOfTheDefault) {
  const Camera camera = small_camera(DepthErrorKind::circular, 1);
  const auto codes = [&](double effort) {
    return optimize(camera, 4, with_effort(short_descents(), effort).optimize);
  };
  const std::vector<Candidate> usual = codes(1.0), twice = codes(2.0);
  ASSERT_EQ(usual.size(), 1u);
  ASSERT_EQ(twice.size(), 2u);
  for (std::size_t k = 0; k < usual.size(); ++k)
    for (int e = 0; e < 4; ++e) {
      EXPECT_EQ(usual[k].code.modulation(e), twice[k].code.modulation(e));
      EXPECT_EQ(usual[k].code.demodulation(e), twice[k].code.demodulation(e));
    }
}

TEST(MixerDesign, EqualsThatOfTwoBucketsReadAsADifference) {
  Camera camera = small_camera(DepthErrorKind::circular, 1);
  camera.sensor.demodulation = Demodulation::weight;
  DesignOptions options = short_descents();
  options.optimize.starts = 4;
  options.optimize.hops = 5;
  options.optimize.refinement_steps = 40;
  const std::vector<CodeSet> also = {build_family("hamiltonian-k4", camera)};
  const std::vector<CodeSet> of_buckets = {also[0].buckets_of_signed()};
  const std::vector<Candidate> found = optimize(camera, 4, options.optimize, also);
  const std::vector<Candidate> expected =
      optimize(in_buckets(camera), 4, options.optimize, of_buckets);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_FALSE(why_not_playable(found[k].code, camera));
    EXPECT_EQ(found[k].per_measurement.size(), 4u);
    for (int e = 0; e < 4; ++e)
      EXPECT_EQ(found[k].code.demodulation(e), expected[k].code.demodulation(2 * e));
  }

  options.baselines = {"hamiltonian-k4", "sinusoid-k4"};
  for (const bool binary : {true, false}) {
    camera.sensor.binary = binary;
    const DesignResult result = design(camera, options);
    EXPECT_TRUE(result.winner().code.is_signed());
    EXPECT_TRUE(result.find("hamiltonian-k4"));
  }
  options.method = DesignMethod::factorize;
  options.target = targets_of(build_family("hamiltonian-k4", small_camera({}, 1)));
  const DesignResult factorized = design(camera, options);
  EXPECT_TRUE(factorized.find("hamiltonian-k4-factorized")->code.is_signed());
}

TEST(MixerDesign, RejectsUnsupportedRequests) {
  Camera camera = small_camera(DepthErrorKind::circular, 1);
  camera.sensor.demodulation = Demodulation::weight;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.shortest_pulse_s = 1.0 / (8 * camera.fundamental_frequency_hz);
  DesignOptions options = short_descents();
  const auto refusal = [&] { return refusal_of([&] { design(camera, options); }); };
  options.method = DesignMethod::search;
  EXPECT_THAT(refusal(), HasSubstr("sensor.demodulation = signed; must be"));
  options.method = DesignMethod::optimize;
  camera.sensor.tap_mismatch = 0.1;
  EXPECT_THAT(refusal(), HasSubstr("sensor.tap_mismatch = 0.1; must be 0"));
}

// Design for any camera returns a code or a message with the limiting setting.
//
//   TOFSMITH_ALL_RANDOM_CAMERAS=1 test_design --gtest_filter='RandomCameras.*'
//
// tests 1000 cameras without search, some of them against all standard codes, and 50 with the
// default effort. Otherwise a fixed subset is tested with little effort.

constexpr std::uint64_t seed = 1;

bool all_are_tried() { return std::getenv("TOFSMITH_ALL_RANDOM_CAMERAS") != nullptr; }

/// Returns whether a setting can by itself make depth measurement impossible.
bool names_a_physical_reason(const std::string& field) {
  for (const char* known : {"light.peak_factor", "number of exposure_s", "number of playback.order",
                            "sensor.taps", "codes that measure depth"})
    if (field == known) return true;
  return false;
}

/// @param methods  receives the methods of all candidates
void expect_a_code_or_a_reason(std::uint64_t index, double effort, std::set<std::string>& methods) {
  const Camera camera = random_camera(seed, index);
  SCOPED_TRACE(camera.name);
  ASSERT_NO_THROW(camera.validate());
  DesignOptions options = with_effort({}, effort);
  options.trials = 1000;
  // Searching all standard codes for contenders takes seconds.
  if (index % 16 != 0 || !all_are_tried())
    options.baselines = {"sinusoid-k3", "square-k4", "hamiltonian-k4"};
  try {
    const DesignResult result = design(camera, options);
    EXPECT_EQ(why_not_playable(result.winner().code, camera), std::nullopt);
    for (const Candidate& c : result.candidates) {
      methods.insert(c.method);
      EXPECT_TRUE(std::isfinite(c.error.circular.geometric_mean_m.value)) << c.code.name();
    }
  } catch (const InvalidArgument& refusal) {
    EXPECT_TRUE(names_a_physical_reason(refusal.field())) << refusal.what();
    EXPECT_LT(std::string(refusal.what()).size(), 700u) << refusal.what();
  }
}

TEST(RandomCameras, GiveACodeOrAReasonWithoutEffort) {
  constexpr std::uint64_t slowest = 840;  // takes longer than all others together
  const std::uint64_t cameras = all_are_tried() ? 1000 : repetitions(25u);
  const std::uint64_t step = all_are_tried() ? 1 : 40;
  std::set<std::string> methods;
  for (std::uint64_t i = 0; i < cameras; ++i)
    if (all_are_tried() || step * i != slowest) expect_a_code_or_a_reason(step * i, 0.0, methods);
  EXPECT_THAT(methods, testing::IsSupersetOf({"atlas", "family"}));
}

TEST(RandomCameras, GiveACodeOrAReasonForEveryMethod) {
  std::set<std::string> methods;
  if (all_are_tried())
    for (std::uint64_t i = 1000; i < 1050; ++i) expect_a_code_or_a_reason(i, 1.0, methods);
  else
    for (const std::uint64_t i : {1009, 1016, 1020, 1041})
      expect_a_code_or_a_reason(i, 0.01, methods);
  EXPECT_THAT(methods, testing::IsSupersetOf({"naive", "factorize", "optimize"}));
}

}  // namespace

}  // namespace tofsmith

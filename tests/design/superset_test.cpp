// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A larger search space or a longer search never yields a worse code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

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

double error_m(const Camera& camera, const DesignOptions& options) {
  return geometric_mean_error_m(design(camera, options).winner().error, camera.operating.error);
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
      const double switching_m = error_m(switching, options);
      EXPECT_LE(error_m(light, options), switching_m);
      EXPECT_LE(error_m(both, options), switching_m);
    }
}

TEST(Superset, MoreEffortIsNeverWorse) {
  for (const int taps : {1, 2}) {
    const Camera camera = small_camera(DepthErrorKind::circular, taps);
    const double usual_m = error_m(camera, short_descents());
    const double twice_m = error_m(camera, with_effort(short_descents(), 2.0));
    EXPECT_LE(twice_m, usual_m);
    EXPECT_LE(error_m(camera, with_effort(short_descents(), 4.0)), twice_m);
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
  const auto refusal = [&] {
    try {
      design(camera, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  options.method = DesignMethod::search;
  EXPECT_THAT(refusal(), HasSubstr("sensor.demodulation = signed; must be"));
  options.method = DesignMethod::optimize;
  camera.sensor.tap_mismatch = 0.1;
  EXPECT_THAT(refusal(), HasSubstr("sensor.tap_mismatch = 0.1; must be 0"));
}

}  // namespace
}  // namespace tofsmith

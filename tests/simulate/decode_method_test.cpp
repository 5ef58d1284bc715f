// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "decode_setup.hpp"
#include "simulate/depth_trials.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

Estimate error_of(const char* code, const char* camera_name, OperatingPoint point,
                  DecodeMethod method, UnwrapWeights weights = UnwrapWeights::variance) {
  Camera camera = built_in_camera(camera_name);
  camera.operating.signal_e_per_s = {point.signal_e_per_s};
  camera.operating.ambient_e_per_s = {point.ambient_e_per_s};
  return evaluate(build_family(code, camera), camera,
                  {.trials = 20000,
                   .method = method,
                   .unwrap_weights = weights,
                   .draw_every_measurement = true})
      .points[0]
      .circular_mde_m;
}

double ratio_of(const char* camera, OperatingPoint point, UnwrapWeights weights) {
  return error_of("multifrequency-k5", camera, point, DecodeMethod::unwrap, weights).value /
         error_of("multifrequency-k5", camera, point, DecodeMethod::zncc).value;
}

TEST(DecodeMethods, ZnccBeatsClassicalUnwrappingInLowLight) {
  // Both decode the same noise, so that ratios are far more precise than errors.
  const OperatingPoint low{3162.3, 1e3};
  EXPECT_GT(ratio_of("paper-30x", low, UnwrapWeights::frequency), 1.0);
  EXPECT_GT(ratio_of("paper-10f0", low, UnwrapWeights::frequency), 1.02);
  EXPECT_GT(ratio_of("paper-5f0", low, UnwrapWeights::frequency), 1.1);
}

TEST(DecodeMethods, WeightsByVarianceAreNoWorseThanClassicalOnes) {
  for (const char* camera : {"paper-30x", "paper-10f0", "paper-5f0"})
    for (const OperatingPoint point : {OperatingPoint{3162.3, 1e3}, OperatingPoint{1e5, 1e4}})
      EXPECT_LT(ratio_of(camera, point, UnwrapWeights::variance),
                1.005 * ratio_of(camera, point, UnwrapWeights::frequency))
          << camera;
}

TEST(DecodeMethods, UnwrappingIsNearlyAsGoodAtHighLightWithoutABandLimit) {
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
    EXPECT_NEAR(ratio_of("paper-30x", {1e5, 1e2}, weights), 1.0, 0.08) << name_of(weights);
}

TEST(DecodeMethods, FrequencyWeightsCostMoreUnderABandLimit) {
  const double by_variance = ratio_of("paper-10f0", {1e5, 1e2}, UnwrapWeights::variance);
  const double by_frequency = ratio_of("paper-10f0", {1e5, 1e2}, UnwrapWeights::frequency);
  EXPECT_GT(by_frequency, 1.1);
  EXPECT_LT(by_variance, by_frequency);
}

TEST(DecodeMethods, UnsuitableCodesAreRejected) {
  const Camera camera = built_in_camera("paper-10f0");
  EXPECT_THROW(evaluate(build_family("hamiltonian-k3", camera), camera,
                        {.trials = 100, .method = DecodeMethod::unwrap}),
               std::invalid_argument);
}

Camera camera_at(OperatingPoint point, std::vector<double> exposure_s = {}) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {point.signal_e_per_s};
  camera.operating.ambient_e_per_s = {point.ambient_e_per_s};
  camera.exposure_s.each_s = std::move(exposure_s);
  return camera;
}

/// All methods see the same noise.
std::vector<double> errors_bin(const CodeSet& code, const Camera& camera, DecodeMethod method) {
  constexpr std::int64_t count = 10240;
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera,
                           {.trials = count, .method = method, .draw_every_measurement = true});
  std::vector<double> errors;
  const auto tile = std::make_unique<TrialTile>();
  for (std::int64_t first = 0; first < count; first += trials_per_tile) {
    const TrialBlock block = trials.run({0, 0, count}, {first, first + trials_per_tile}, *tile);
    for (std::size_t i = 0; i < block.true_bin.size(); ++i)
      errors.push_back(std::abs(circular_difference(block.decoded_bin[i], block.true_bin[i],
                                                    static_cast<double>(trials.samples()))));
  }
  return errors;
}

struct Comparison {
  RunningStatistics zncc, ml, rise;  ///< rise: error with ml minus error with zncc, per trial

  Comparison(const CodeSet& code, const Camera& camera) {
    const std::vector<double> by_zncc = errors_bin(code, camera, DecodeMethod::zncc);
    const std::vector<double> by_ml = errors_bin(code, camera, DecodeMethod::ml);
    for (std::size_t i = 0; i < by_zncc.size(); ++i) {
      zncc.add(by_zncc[i]);
      ml.add(by_ml[i]);
      rise.add(by_ml[i] - by_zncc[i]);
    }
  }
  double ratio() const { return ml.mean() / zncc.mean(); }
};

TEST(MaximumLikelihood, IsNotWorseThanZnccOnGoodCodes) {
  for (const char* name :
       {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4", "multifrequency-k5"})
    for (const OperatingPoint point :
         {OperatingPoint{1e3, 1e3}, OperatingPoint{1e4, 1e4}, OperatingPoint{1e5, 1e2}}) {
      const Camera camera = camera_at(point);
      const Comparison compared(build_family(name, camera), camera);
      EXPECT_LE(compared.rise.mean(), 3 * compared.rise.standard_error())
          << name << " at " << point.signal_e_per_s;
    }
}

TEST(MaximumLikelihood, IsBetterInLowAmbientLight) {
  // Shot noise then differs between measurements, and ambient light is known to be non-negative.
  const Camera camera = camera_at({1e5, 1e2});
  EXPECT_LT(Comparison(build_family("hamiltonian-k5", camera), camera).ratio(), 0.96);
  EXPECT_LT(Comparison(build_family("gray-k4", camera), camera).ratio(), 0.81);
}

TEST(MaximumLikelihood, IsBetterOnUnequalExposures) {
  for (const OperatingPoint point : {OperatingPoint{1e5, 1e4}, OperatingPoint{1e5, 1e2}}) {
    const Camera camera = camera_at(point, {0.01, 0.02, 0.05, 0.08, 0.14});
    const Comparison compared(build_family("hamiltonian-k5", camera), camera);
    EXPECT_LT(compared.rise.mean(), -4 * compared.rise.standard_error());
  }
}

/// Gates of 10 %, 50 % and 90 % of the period.
CodeSet code_of_unequal_duties(int samples) {
  const std::vector<Waveform> pulse(5, Waveform::binary({{0.0, 0.125}}, 8.0));
  return CodeSet::create("unequal-duties", samples, 1, pulse,
                         {Waveform::binary({{0.0, 0.5}}), Waveform::binary({{0.25, 0.75}}),
                          Waveform::binary({{0.05, 0.95}}), Waveform::binary({{0.55, 0.65}}),
                          Waveform::binary({{0.8, 0.9}})});
}

TEST(MaximumLikelihood, IsBetterOnUnequalDuties) {
  for (const double ambient_e_per_s : {1e2, 1e4}) {
    const Camera camera = camera_at({1e5, ambient_e_per_s});
    EXPECT_LT(Comparison(code_of_unequal_duties(camera.samples), camera).ratio(), 0.93);
  }
}

TEST(TableDepthError, EqualsTheDepthErrorOfTheCode) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    Camera camera = camera_with("paper-30x", 2, readout);
    camera.operating.signal_e_per_s = {1e4};
    camera.operating.ambient_e_per_s = {1e4};
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const DecodingTable table = make_decoding_table(ForwardModel(code, camera), camera);
    const Estimate of_code = evaluate(code, camera).points[0].circular_mde_m;
    const Estimate of_table = table_depth_error_m(table, {1e4, 1e4});
    EXPECT_NEAR(of_table.value, of_code.value,
                4 * std::hypot(of_table.standard_error, of_code.standard_error));
    EXPECT_GT(of_table.standard_error, 0.0);
    EXPECT_LT(of_table.standard_error, 0.05 * of_table.value);
  }
}

TEST(TableDepthError, DoesNotDependOnGainOffsetOrThreads) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  DecodingTable counts = setup.decoder.table();
  const double electrons_m = table_depth_error_m(counts, {2e4, 1e3}, 4000).value;
  counts.gain_e_per_raw << 0.5, 2.0, 0.25, 4.0;
  counts.black_level << 64.0, -32.0, 7.0, 0.0;
  EXPECT_NEAR(table_depth_error_m(counts, {2e4, 1e3}, 4000).value, electrons_m, 1e-5 * electrons_m);
  EXPECT_THROW(table_depth_error_m(counts, {2e4, 1e3}, 1), std::invalid_argument);
  const ThreadLimit one(1);
  EXPECT_EQ(table_depth_error_m(setup.decoder.table(), {2e4, 1e3}, 4000).value, electrons_m);
}

}  // namespace

}  // namespace tofsmith

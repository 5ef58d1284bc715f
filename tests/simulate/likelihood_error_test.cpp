// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "simulate/depth_trials.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

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

}  // namespace
}  // namespace tofsmith

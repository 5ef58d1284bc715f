// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/range_emulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

Camera prototype_without_noise() {
  Camera camera = built_in_camera("prototype");
  camera.sensor.read_noise_e = 0.0;
  camera.exposure_s.total_s = 1e9;  // shot noise far below every tolerance
  return camera;
}

TEST(RangeEmulation, WithoutNoiseEveryShiftIsRecovered) {
  const Camera camera = prototype_without_noise();
  for (const char* name : {"hamiltonian-k4", "sinusoid-k4", "multifrequency-k5"}) {
    const RangeEmulation emulation = emulate_range(build_family(name, camera), camera,
                                                   {.target_m = 0.7, .shifts = 20, .estimates = 4});
    ASSERT_EQ(emulation.depths.size(), 20u);
    for (int j = 0; j < 20; ++j) {
      const EmulatedDepth& depth = emulation.depths[static_cast<std::size_t>(j)];
      EXPECT_NEAR(depth.true_m, wrap(0.7 + j * camera.range_m() / 20, camera.range_m()), 1e-12);
      EXPECT_LT(depth.circular_mde_m.value, 0.01) << name << ", shift " << j;
      EXPECT_LE(std::abs(depth.mean_error_m.value), depth.circular_mde_m.value + 1e-15);
    }
  }
}

TEST(RangeEmulation, IsWhatADelayedGeneratorMeasures) {
  // The generator's own waveforms are on its points: delaying those is delaying what is played.
  Camera camera = built_in_camera("prototype");
  const CodeSet nominal = build_family("hamiltonian-k4", camera);
  const ActualCode actual = actual_code(nominal, camera);
  camera.light.generator = camera.sensor.generator = std::nullopt;
  for (const int shift : {1, 7, 13}) {
    std::vector<Waveform> delayed;
    for (const Waveform& m : actual.modulation) delayed.push_back(m.delayed(shift / 20.0));
    const ForwardModel moved(CodeSet::create("delayed", 300, 2, delayed, actual.demodulation),
                             camera);
    const ForwardModel still(
        CodeSet::create("still", 300, 2, actual.modulation, actual.demodulation), camera);
    EXPECT_LT((moved.correlation(7.0) - still.correlation(wrap(7.0 + shift * 15.0, 300.0))).norm(),
              1e-9);
  }
}

TEST(RangeEmulation, SameBitsForAnyNumberOfThreadsAndOtherSeedsOtherNoise) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const auto run = [&](int threads, std::uint64_t seed) {
    const ThreadLimit limit(threads);
    return emulate_range(code, camera, {.shifts = 5, .estimates = 20, .seed = seed})
        .linear_mde_m.value;
  };
  EXPECT_EQ(run(1, 1), run(2, 1));
  EXPECT_NE(run(1, 1), run(1, 2));
}

TEST(RangeEmulation, TheMeanIsOverShiftsAndPercentOfTheRange) {
  const Camera camera = built_in_camera("prototype");
  const RangeEmulation emulation = emulate_range(build_family("sinusoid-k4", camera), camera,
                                                 {.estimates = 50, .point = {1e4, 1e3}});
  double linear = 0, circular = 0;
  for (const EmulatedDepth& depth : emulation.depths) {
    linear += depth.linear_mde_m.value / 20;
    circular += depth.circular_mde_m.value / 20;
    EXPECT_LE(depth.circular_mde_m.value, depth.linear_mde_m.value + 1e-12);
  }
  EXPECT_NEAR(emulation.linear_mde_m.value, linear, 1e-12);
  EXPECT_NEAR(emulation.circular_mde_m.value, circular, 1e-12);
  EXPECT_NEAR(emulation.percent_of_range(emulation.linear_mde_m).value,
              100 * linear / camera.range_m(), 1e-12);
  EXPECT_GT(emulation.linear_mde_m.standard_error, 0);
}

TEST(RangeEmulation, UnwrapsPhasesIfAskedTo) {
  Camera camera = built_in_camera("prototype");
  camera.sensor.read_noise_e = 0.0;
  const RangeEmulation emulation = emulate_range(
      build_family("multifrequency-k5", camera), camera,
      {.shifts = 4, .estimates = 3, .point = {1e9, 0.0}, .method = DecodeMethod::unwrap});
  for (const EmulatedDepth& depth : emulation.depths) EXPECT_LT(depth.circular_mde_m.value, 0.02);
  EXPECT_THROW(emulate_range(build_family("hamiltonian-k4", camera), camera,
                             {.method = DecodeMethod::unwrap}),
               std::invalid_argument);
}

TEST(Prototype, RoundedAmplitudesCostNoMeasurement) {
  Camera camera = built_in_camera("prototype");
  camera.operating = {{1e5}, {1e3}};
  const DepthErrorReport error =
      evaluate(build_family("sinusoid-k3", camera), camera, {.trials = 4000});
  const PointDepthError& point = error.points.front();
  EXPECT_NEAR(point.circular_mde_m.value, point.cramer_rao_mae_m,
              0.05 * point.cramer_rao_mae_m + 4 * point.circular_mde_m.standard_error);
  EXPECT_LT(point.circular_mde_m.value, 0.1);
}

TEST(RangeEmulation, RefusesNonsense) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("sinusoid-k3", camera);
  for (const RangeEmulationOptions& options :
       {RangeEmulationOptions{.target_m = -1}, RangeEmulationOptions{.target_m = std::nan("")},
        RangeEmulationOptions{.shifts = 0}, RangeEmulationOptions{.estimates = 1},
        RangeEmulationOptions{.point = {-1, 0}}, RangeEmulationOptions{.point = {1, -1}}})
    EXPECT_THROW(emulate_range(code, camera, options), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Clock, droop and combined perturbations; the others are in robustness_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {
namespace {

constexpr RobustnessOptions nothing{
    .bandwidth = 0.0, .peak = 0.0, .edge_jitter_s = 0.0, .tap_mismatch = 0.0};

PerturbedCamera of_clock(const Camera& camera, double clock_s) {
  return {.name = "clock", .camera = camera, .clock_s = clock_s};
}

TEST(Perturbations, ByDefaultExcludeClockDroopAndCombination) {
  for (const PerturbedCamera& p : perturbations(built_in_camera("paper-10f0"))) {
    EXPECT_EQ(p.clock_s, 0.0);
    EXPECT_EQ(p.droop, 0.0);
    EXPECT_NE(p.name, "all together");
  }
}

TEST(Perturbations, TogetherCombineAllOfThem) {
  const Camera camera = built_in_camera("paper-10f0");
  RobustnessOptions options = nothing;
  options.bandwidth = 0.2;
  options.peak = 0.1;
  options.edge_jitter_s = 50e-12;
  options.tap_mismatch = 0.02;
  options.clock_s = 1e-9;
  options.droop = 0.03;
  options.together = true;
  const auto cameras = perturbations(camera, options);
  ASSERT_EQ(cameras.size(), 9u);
  const PerturbedCamera& all = cameras.back();
  EXPECT_EQ(all.name, "all together");
  EXPECT_NEAR(all.camera.light.impulse_response.f_max_hz,
              0.8 * camera.light.impulse_response.f_max_hz, 1.0);
  EXPECT_NEAR(all.peak, 0.9, 1e-12);
  EXPECT_EQ(all.camera.sensor.edge_jitter_s, 50e-12);
  EXPECT_EQ(all.camera.sensor.tap_mismatch, 0.02);
  EXPECT_EQ(all.clock_s, 1e-9);
  EXPECT_EQ(all.droop, 0.03);
}

TEST(PerturbedCode, SwitchesOnClockTicks) {
  const Camera camera = built_in_camera("paper-10f0");  // period 66.7 ns
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const double clock_s = 5e-9;
  const double points = std::floor(1.0 / (camera.fundamental_frequency_hz * clock_s));
  const CodeSet actual = perturbed_code(code, of_clock(camera, clock_s));
  const auto on_points = [&](const Waveform& w, const Waveform& nominal) {
    ASSERT_EQ(w.on_intervals().size(), nominal.on_intervals().size());
    for (std::size_t i = 0; i < w.on_intervals().size(); ++i) {
      const double rise = w.on_intervals()[i].rise * points;
      EXPECT_NEAR(rise, std::round(rise), 1e-9);
    }
  };
  for (int k = 0; k < 4; ++k) {
    on_points(actual.demodulation(k), code.demodulation(k));
    on_points(actual.modulation(k), code.modulation(k));
    EXPECT_LE(actual.modulation(k).mean(), 1.0 + 1e-12);
  }
  EXPECT_THROW(perturbed_code(code, of_clock(camera, 60e-9)), std::invalid_argument);
}

TEST(PerturbedCode, DroopsAfterEveryRise) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet square = build_family("square-k4", camera);  // on for half the period
  const PerturbedCamera droopy{.name = "droop", .camera = camera, .droop = 0.1};
  const CodeSet actual = perturbed_code(square, droopy);
  const Waveform& nominal = square.modulation(0);
  ASSERT_TRUE(nominal.is_binary());
  const double length = nominal.on_intervals()[0].fall - nominal.on_intervals()[0].rise;
  const double rate = -std::log(0.9) / 0.5;
  EXPECT_NEAR(actual.modulation(0).mean(), nominal.level() * (1 - std::exp(-rate * length)) / rate,
              1e-12);
  EXPECT_LT(actual.modulation(0).peak(), nominal.level());
  EXPECT_EQ(actual.demodulation(0), square.demodulation(0));
  // The last cell of a pulse of half a period is 10 % lower.
  const CodeSet half = CodeSet::create("half", 240, 1, {Waveform::binary({{0.0, 0.5}}, 2.0)},
                                       {Waveform::binary({{0.0, 0.5}})});
  const Eigen::VectorXd cells = perturbed_code(half, droopy).modulation(0).samples();
  EXPECT_NEAR(cells[119] / cells[0], 0.9, 1e-3);
  EXPECT_EQ(cells[120], 0.0);
}

TEST(PerturbedCode, WithoutAChangeEqualsTheCode) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const CodeSet same = perturbed_code(code, {.name = "none", .camera = camera});
  for (int k = 0; k < 3; ++k) EXPECT_EQ(same.modulation(k), code.modulation(k));
}

TEST(Robustness, ReportsClockDroopAndCombination) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e4};
  RobustnessOptions options = nothing;
  options.clock_s = 2e-9;
  options.droop = 0.05;
  options.together = true;
  options.trials = 400;
  const RobustnessReport report =
      robustness(build_family("hamiltonian-k3", camera), camera, options);
  ASSERT_EQ(report.perturbed.size(), 3u);
  EXPECT_TRUE(report.perturbed[0].name.starts_with("clock 2.02 ns"));
  EXPECT_EQ(report.perturbed[1].name, "droop 5 %");
  for (const PerturbedError& p : report.perturbed) EXPECT_GT(p.calibrated_m.value, 0.0);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/generator_report.hpp"

namespace tofsmith {
namespace {

constexpr double frequency_hz = 5e6;

TEST(GeneratorTable, IsOutputPointByPointIfTheRateAllows) {
  Generator generator{.sample_rate_hz = 500e6};
  EXPECT_EQ(generator.points_in_table(frequency_hz), 100);
  generator.table_points = 48;
  EXPECT_EQ(generator.points_per_period(frequency_hz), 48);
  const Waveform nominal = Waveform::binary({{0.13, 0.71}});
  EXPECT_EQ(generated(nominal, generator, frequency_hz),
            generator_table(nominal, generator, frequency_hz));
  EXPECT_EQ(generated(nominal, generator, frequency_hz),
            generated(nominal, {.sample_rate_hz = 48 * frequency_hz}, frequency_hz));
}

TEST(GeneratorTable, WithMorePointsThanTheRateAllowsIsSubsampled) {
  const Generator generator{.sample_rate_hz = 500e6, .table_points = 16384};
  EXPECT_EQ(generator.points_per_period(frequency_hz), 100);
  EXPECT_EQ(generator.points_in_table(frequency_hz), 16384);
  const Waveform nominal = Waveform::binary({{0.123456, 0.654321}});
  const Waveform table = generator_table(nominal, generator, frequency_hz);
  const Waveform actual = generated(nominal, generator, frequency_hz);
  EXPECT_NEAR(table.on_intervals()[0].rise, 0.123456, 0.5 / 16384);
  for (int j = 0; j < 100; ++j) {
    const double middle = (j + 0.5) / 100;
    const auto is_on = [middle](const Waveform& w) {
      return w.on_intervals()[0].rise <= middle && middle < w.on_intervals()[0].fall;
    };
    EXPECT_EQ(is_on(actual), is_on(table)) << j;
  }
  Eigen::VectorXd samples(1000);
  for (int i = 0; i < 1000; ++i) samples[i] = 1.0 + std::sin(0.01 * i);
  const Waveform smooth = Waveform::sampled(samples);
  const Waveform points = generated(smooth, generator, frequency_hz);
  ASSERT_EQ(points.samples().size(), 100);
  for (int j = 0; j < 100; ++j) EXPECT_NEAR(points.samples()[j], samples[10 * j + 5], 0.011);
}

TEST(EdgeGrid, MovesEverySwitchingTimeToTheNearestMultiple) {
  // Grid of 10 ns, points of 2 ns.
  const Generator generator{.sample_rate_hz = 500e6, .edge_grid_s = 10e-9};
  for (std::uint32_t i = 0; i < 50; ++i) {
    RandomStream random(31, i);
    const double rise = 0.4 * random.uniform(), fall = 0.5 + 0.4 * random.uniform();
    const Waveform actual = generated(Waveform::binary({{rise, fall}}), generator, frequency_hz);
    const OnInterval on = actual.on_intervals()[0];
    EXPECT_NEAR(on.rise * 20, std::round(rise * 20), 1e-9);
    EXPECT_NEAR(on.fall * 20, std::round(fall * 20), 1e-9);
    EXPECT_EQ(on.rise, generated_switching_time(rise, generator, frequency_hz));
  }
}

TEST(EdgeGrid, IsReported) {
  Camera camera = built_in_camera("prototype");
  camera.light.generator->edge_grid_s = camera.sensor.generator->edge_grid_s = 20e-9;
  const CodeSet code = CodeSet::create("x", camera.samples, 2, {rectangular_pulse(0.3, 0.02)},
                                       {square_wave(1, 0.0), square_wave(1, 0.5)});
  const auto reports = generator_report(code, camera);
  // Rise 4 ns to 0, fall 64 ns to 60 ns.
  EXPECT_NEAR(*reports[0].largest_edge_move_s, 4e-9, 1e-15);
  EXPECT_NEAR(reports[0].duty_actual, 0.3, 1e-12);
}

TEST(Generator, RejectsInvalidTablesAndGrids) {
  const auto problem = [](const Generator& generator) -> std::string {
    try {
      generator.validate("g", frequency_hz);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem({.table_points = 1}), "g.table_points = 1; must be in [2, 1048576]");
  EXPECT_EQ(problem({.edge_grid_s = 0.0}), "g.edge_grid_s = 0; must be finite and > 0");
  EXPECT_EQ(problem({.edge_grid_s = 30e-9}),
            "g.edge_grid_s = 3e-08; must divide the period of fundamental_frequency_hz = 5000000 "
            "into 2 to 1048576 integer steps (it gives 6.66667; 2.85714286e-08 s would give 7)");
  EXPECT_EQ(problem({.edge_grid_s = 1.0}),
            "g.edge_grid_s = 1; must divide the period of fundamental_frequency_hz = 5000000 into "
            "2 to 1048576 integer steps");
  EXPECT_EQ(problem({.sample_rate_hz = 500e6, .table_points = 16384, .edge_grid_s = 2e-9}), "");
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "core/shared/random.hpp"
#include "refusal.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr double frequency_hz = 5e6;

Generator generator_of(int points, int bits = 14) { return {points * frequency_hz, bits}; }

double value_at(const Waveform& waveform, double t) {
  if (!waveform.is_binary())
    return waveform
        .samples()[static_cast<Eigen::Index>(t * static_cast<double>(waveform.samples().size()))];
  for (const OnInterval& on : waveform.on_intervals())
    if ((t >= on.rise && t < on.fall) || t + 1.0 < on.fall) return waveform.level();
  return 0.0;
}

/// Covers never to always on, touching pulses, and a pulse across the end.
Waveform random_binary(RandomStream& random) {
  std::vector<double> times(2 * (random() % 12));
  for (double& time : times) time = random.uniform();
  std::sort(times.begin(), times.end());
  std::vector<OnInterval> on;
  for (std::size_t i = 0; i + 1 < times.size(); i += 2) on.push_back({times[i], times[i + 1]});
  const Waveform waveform = Waveform::binary(std::move(on), 0.5 + random.uniform());
  return random() % 2 == 0 ? waveform : waveform.delayed(random.uniform());
}

TEST(Generator, OutputsTheValueAtTheMiddleOfEveryPoint) {
  for (std::uint32_t i = 0; i < 300; ++i) {
    RandomStream random(21, i);
    const Waveform nominal = random_binary(random);
    const int points = 2 + static_cast<int>(random() % 30);
    const Waveform actual = generated(nominal, generator_of(points), frequency_hz);
    ASSERT_TRUE(actual.is_binary());
    for (int j = 0; j < points; ++j) {
      const double middle = (j + 0.5) / points;
      EXPECT_EQ(value_at(actual, middle), value_at(nominal, middle)) << "case " << i;
      EXPECT_EQ(value_at(actual, (j + 0.01) / points), value_at(actual, (j + 0.99) / points));
    }
  }
}

TEST(Generator, MovesSwitchingTimesByAtMostHalfAPointWithConsistentTies) {
  const Waveform nominal = Waveform::binary({{0.125, 0.375}, {0.625, 0.875}});
  const Waveform actual = generated(nominal, generator_of(100), frequency_hz);
  ASSERT_EQ(actual.on_intervals().size(), 2u);
  EXPECT_DOUBLE_EQ(actual.on_intervals()[0].rise, 0.12);
  EXPECT_DOUBLE_EQ(actual.on_intervals()[0].fall, 0.37);
  EXPECT_DOUBLE_EQ(actual.on_intervals()[1].rise, 0.62);
  EXPECT_DOUBLE_EQ(actual.on_intervals()[1].fall, 0.87);
  for (std::uint32_t i = 0; i < 100; ++i) {
    RandomStream random(23, i);
    const double t = random.uniform();
    EXPECT_LE(std::abs(nearest_point(t, 100) - 100 * t), 0.5 + 1e-9);
  }
}

TEST(Generator, RoundsAmplitudesByAtMostHalfAStep) {
  RandomStream random(24, 0);
  Eigen::VectorXd samples(60);
  for (double& sample : samples) sample = 0.8 * random.uniform();
  const Waveform nominal = Waveform::sampled(samples);
  for (const int bits : {1, 3, 8, 14}) {
    const double step = nominal.peak() / (std::exp2(bits) - 1);
    const Waveform actual = generated(nominal, generator_of(60, bits), frequency_hz);
    EXPECT_LE((actual.samples() - samples).cwiseAbs().maxCoeff(), step / 2 + 1e-12) << bits;
    EXPECT_EQ(actual.peak(), nominal.peak());
    for (const double value : actual.samples())
      EXPECT_NEAR(value / step, std::round(value / step), 1e-6);
  }
}

TEST(Generator, UsesAsManyWholePointsAsTheRateAllows) {
  EXPECT_EQ(Generator{}.points_per_period(5e6), 100);
  EXPECT_EQ(Generator{}.points_per_period(15e6), 33);
  for (const int n : {3, 7, 33, 49, 100, 999}) EXPECT_EQ(generator_of(n).points_per_period(5e6), n);
}

TEST(Generator, RejectsUnsupportedWaveforms) {
  const Waveform pulse = rectangular_pulse(0.5);
  EXPECT_THROW(generated(pulse, {9e6, 14}, 5e6), std::invalid_argument);
  EXPECT_THROW(generated(pulse, {500e6, 0}, 5e6), std::invalid_argument);
  EXPECT_THROW(generated(pulse, {500e6, 25}, 5e6), std::invalid_argument);
  EXPECT_THROW(generated(pulse, {std::nan(""), 14}, 5e6), std::invalid_argument);
  EXPECT_THROW(generated(Waveform::sampled(Eigen::Vector2d(-0.5, 1)), {}, 5e6),
               std::invalid_argument);
  Camera camera = built_in_camera("paper-10f0");
  camera.light.generator = Generator{.sample_rate_hz = 20e6};
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  // A pulse of 1/30 of a period may fall between points of 1/5.
  camera = built_in_camera("paper-30x");
  camera.light.generator = Generator{.sample_rate_hz = 5 * 15e6};
  const CodeSet code = build_family("hamiltonian-k5", camera);
  EXPECT_THROW(actual_code(code, camera), std::invalid_argument);
}

TEST(ActualCode, KeepsTheAveragePowerThePeakAndTheComplement) {
  const Camera camera = built_in_camera("prototype");
  for (const char* name : {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4",
                           "square-k3", "multifrequency-k5", "pulsed-multifrequency-k5"}) {
    const CodeSet code = build_family(name, camera);
    const ActualCode actual = actual_code(code, camera);
    for (const Waveform& m : actual.modulation) {
      EXPECT_LE(m.mean(), 1 + 1e-12) << name;
      EXPECT_GT(m.mean(), 0.85) << name;
      EXPECT_LE(m.peak(), camera.light.peak_factor * (1 + 1e-12)) << name;
    }
    for (std::size_t i = 0; i < actual.demodulation.size(); i += 2)
      EXPECT_LT((actual.demodulation[i].cell_averages(100) +
                 actual.demodulation[i + 1].cell_averages(100) - Eigen::VectorXd::Ones(100))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-12)
          << name;
  }
}

TEST(ActualCode, IsUsedByTheForwardModel) {
  const Camera camera = built_in_camera("prototype");
  for (const char* name : {"hamiltonian-k4", "sinusoid-k3"}) {
    const CodeSet code = build_family(name, camera);
    const ActualCode actual = actual_code(code, camera);
    const ForwardModel model(code, camera);
    const Eigen::MatrixXd table = model.tap_correlation_table(90);
    const Eigen::VectorXcd transfer = camera.transfer(2400);
    for (int i = 0; i < code.measurements(); ++i) {
      const Waveform& d = actual.demodulation[static_cast<std::size_t>(i)];
      const Waveform& m = actual.modulation[static_cast<std::size_t>(code.exposure_of(i))];
      EXPECT_LT((CorrelationFunction(d, m, transfer).table(90) - table.col(i)).norm(), 1e-12);
      EXPECT_NEAR(model.tap_ambient_gain()[i], d.mean(), 1e-15);
    }
  }
}

TEST(GeneratorReport, DescribesTheEffectOfTheLimits) {
  const Camera camera = built_in_camera("prototype");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const std::vector<GeneratorReport> reports = generator_report(code, camera);
  ASSERT_EQ(reports.size(), 8u);  // 4 exposures on each arm; second taps need no generator
  const ActualCode actual = actual_code(code, camera);
  for (const GeneratorReport& r : reports) {
    const bool light = r.arm == Arm::light;
    const auto index = static_cast<std::size_t>(r.index);
    const Waveform& nominal = light ? code.modulation(r.index) : code.demodulation(r.index);
    const Waveform& really = light ? actual.modulation[index] : actual.demodulation[index];
    EXPECT_EQ(r.points_per_period, 100);
    EXPECT_DOUBLE_EQ(r.clock_hz, 500e6);
    EXPECT_DOUBLE_EQ(r.duty_nominal, nominal.duty());
    EXPECT_DOUBLE_EQ(r.mean_actual, really.mean());
    EXPECT_LE(*r.largest_edge_move_s, 0.5 / r.clock_hz + 1e-15);
    const Eigen::VectorXd difference = really.cell_averages(6000) - nominal.cell_averages(6000);
    EXPECT_NEAR(r.rms_difference, std::sqrt(difference.squaredNorm() / 6000), 1e-9);
  }
  EXPECT_TRUE(generator_report(build_family("sinusoid-k3", built_in_camera("paper-5f0")),
                               built_in_camera("paper-5f0"))
                  .empty());
}

TEST(Prototype, IsABipolarMixer) {
  const Camera camera = built_in_camera("prototype");
  EXPECT_NEAR(camera.range_m(), 29.979, 1e-3);
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const ForwardModel model(code, camera);
  ASSERT_EQ(model.measurements(), 4);
  const ActualCode actual = actual_code(code, camera);
  const Eigen::VectorXcd transfer = camera.transfer(2400);
  for (int i = 0; i < 4; ++i) {
    // (2 d - 1) after both arms: 2 chi - mean m.
    const auto tap = static_cast<std::size_t>(2 * i), exposure = static_cast<std::size_t>(i);
    const CorrelationFunction chi(actual.demodulation[tap], actual.modulation[exposure], transfer);
    EXPECT_NEAR(model.correlation(77.7)[i],
                2 * chi(77.7 / 300) - actual.modulation[exposure].mean(), 1e-9);
    EXPECT_NEAR(model.constant_variance_e2()[i], 400.0, 1e-9);
  }
}

TEST(Prototype, NegligibleAmbientLeakageIsNotAnUnknown) {
  // Rounded amplitudes cause duty errors of 1e-6; a square wave with odd points would cause 1e-2.
  Camera camera = built_in_camera("prototype");
  const CodeSet sinusoid = build_family("sinusoid-k3", camera);
  EXPECT_TRUE(unknown_ambient_gain(ForwardModel(sinusoid, camera), camera).isZero(0.0));
  camera.operating.ambient_e_per_s = {1e3, 1e15};
  camera.sensor.tap_mismatch = 1e-3;
  EXPECT_FALSE(unknown_ambient_gain(ForwardModel(sinusoid, camera), camera).isZero(0.0));
  camera = built_in_camera("prototype");
  const ForwardModel unequal(build_family("hamiltonian-k5", camera), camera);
  EXPECT_FALSE(unequal.ambient_gain().isZero(0.0));
}

TEST(Prototype, SignalsSpanThoseOfThePaper) {
  const Camera camera = built_in_camera("prototype");
  const std::vector<double> expected = {1e3, 1e4, 1e5, 1e6};
  ASSERT_EQ(camera.operating.signal_e_per_s.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(camera.operating.signal_e_per_s[i], expected[i], 1e-9 * expected[i]);
}

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
    EXPECT_EQ(value_at(actual, middle), value_at(table, middle)) << j;
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
  const auto problem = [](const Generator& generator) {
    return refusal_of([&] { generator.validate("g", frequency_hz); });
  };
  EXPECT_EQ(problem({.table_points = 1}), "g.table_points = 1; must be in [2, 1048576]");
  EXPECT_EQ(problem({.edge_grid_s = 0.0}), "g.edge_grid_s = 0; must be finite and > 0");
  EXPECT_EQ(problem({.edge_grid_s = 30e-9}),
            "g.edge_grid_s = 3e-08; must divide the period of fundamental_frequency_hz = 5000000 "
            "into 2 to 1048576 integer steps (it gives 6.66667; 2.85714286e-08 s would give 7)");
  EXPECT_EQ(problem({.edge_grid_s = 1.0}),
            "g.edge_grid_s = 1; must divide the period of fundamental_frequency_hz = 5000000 into "
            "2 to 1048576 integer steps");
  EXPECT_EQ(problem({.sample_rate_hz = 500e6, .table_points = 16384, .edge_grid_s = 2e-9}),
            "accepted");
}

}  // namespace

}  // namespace tofsmith

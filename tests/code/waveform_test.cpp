// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/code_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "code/shared/on_intervals.hpp"
#include "core/shared/random.hpp"

namespace tofsmith {

namespace {

/// Disjoint and sorted; the last one may wrap around the end of the period.
std::vector<OnInterval> random_intervals(RandomStream& random) {
  const int count = 1 + static_cast<int>(6 * random.uniform());
  std::vector<double> edges(static_cast<std::size_t>(2 * count));
  for (double& edge : edges) edge = random.uniform();
  std::sort(edges.begin(), edges.end());
  if (random.uniform() < 0.5) {  // the first edge is the fall of the last interval
    std::rotate(edges.begin(), edges.begin() + 1, edges.end());
    edges.back() += 1.0;
  }
  std::vector<OnInterval> on;
  for (std::size_t i = 0; i < edges.size(); i += 2) on.push_back({edges[i], edges[i + 1]});
  return on;
}

bool covers(const std::vector<OnInterval>& on, double t) {
  for (const OnInterval& interval : on)
    for (int periods = -8; periods <= 8; ++periods)
      if (interval.rise <= t + periods && t + periods < interval.fall) return true;
  return false;
}

TEST(OnIntervals, RisesJustBelowZeroBecomeZero) {
  EXPECT_EQ(within_period({{-1e-17, 0.2}}), (std::vector<OnInterval>{{0.0, 0.2}}));
  EXPECT_EQ(within_period({{1.0, 1.2}}), (std::vector<OnInterval>{{0.0, 1.2 - 1.0}}));
  EXPECT_EQ(within_period({{0.9, 1.1}, {0.3, 0.4}}),
            (std::vector<OnInterval>{{0.3, 0.4}, {0.9, 1.1}}));
}

TEST(OnIntervals, StretchedIntervalsFormAWaveformThatCoversThem) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(1, i);
    const std::vector<OnInterval> on = random_intervals(random);
    const double factor = std::exp(3.0 * random.uniform() - 1.0);
    const std::vector<OnInterval> longer = stretched(on, factor);
    EXPECT_NO_THROW(Waveform::binary(longer)) << i;
    std::vector<OnInterval> each;
    for (const OnInterval& interval : on) {
      const double centre = 0.5 * (interval.rise + interval.fall);
      const double half = 0.5 * factor * (interval.fall - interval.rise);
      each.push_back({centre - half, centre + half});
    }
    for (int n = 0; n < 50; ++n) {
      const double t = random.uniform();
      EXPECT_EQ(covers(longer, t), covers(each, t)) << i << ": " << t;
    }
  }
}

TEST(OnIntervals, StretchedIntervalsThatFillThePeriodAreAlwaysOn) {
  EXPECT_EQ(stretched({{0.1, 0.4}, {0.5, 0.9}}, 2.0), (std::vector<OnInterval>{{0.0, 1.0}}));
}

Waveform random_binary(std::uint64_t item) {
  RandomStream random(11, item);
  std::vector<double> times;
  for (int i = 0; i < 6; ++i) times.push_back(random.uniform());
  std::sort(times.begin(), times.end());
  // The last interval wraps around the end of the period.
  return Waveform::binary({{times[1], times[2]}, {times[3], times[4]}, {times[5], times[0] + 1.0}},
                          0.5 + random.uniform());
}

TEST(Waveform, CellAveragesKeepTheMean) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Waveform w = random_binary(i);
    for (const int samples : {7, 60, 241})
      EXPECT_NEAR(w.cell_averages(samples).mean(), w.mean(), 1e-12);
  }
}

TEST(Waveform, CosinesMatchMeanValuesAndHarmonicsOfTheirFormula) {
  const Waveform w = Waveform::cosine(7, 0.5, 0.3, 0.4);
  EXPECT_DOUBLE_EQ(w.mean(), 0.5);
  EXPECT_DOUBLE_EQ(w.peak(), 0.8);
  EXPECT_DOUBLE_EQ(w.minimum(), 0.2);
  const auto value = [](double t) {
    return 0.5 + 0.3 * std::cos(14.0 * std::numbers::pi * t - 0.4);
  };
  for (const int points : {5, 14, 240}) {
    const Eigen::VectorXd middles = w.values_at_middles(points), means = w.cell_averages(points);
    for (int n = 0; n < points; ++n) {
      EXPECT_NEAR(middles[n], value((n + 0.5) / points), 1e-12);
      double mean = 0.0;
      for (int i = 0; i < 200; ++i) mean += value((n + (i + 0.5) / 200) / points) / 200;
      EXPECT_NEAR(means[n], mean, 1e-4);
    }
  }
  EXPECT_NEAR(std::abs(w.harmonics(9)[7]), 0.15, 1e-15);
  EXPECT_EQ(w.harmonics(9)[8], 0.0);
  const Waveform later = w.delayed(0.1), other = w.complement();
  EXPECT_NEAR(later.values_at_middles(1)[0], value(0.4), 1e-12);
  EXPECT_NEAR(other.values_at_middles(1)[0], 1.0 - value(0.5), 1e-12);
}

TEST(Waveform, HarmonicsAreIntegralsUpToThousands) {
  const Waveform switching = random_binary(4);
  const Waveform sampled = Waveform::sampled(switching.cell_averages(60));
  std::vector<OnInterval> cells;  // cells of the sampled waveform
  for (int k = 0; k < 60; ++k) cells.push_back({k / 60.0, (k + 1) / 60.0});
  const Eigen::VectorXcd of_switching = switching.harmonics(2100),
                         of_sampled = sampled.harmonics(2100);
  for (const int n : {1, 59, 60, 63, 64, 65, 500, 2048, 2100}) {
    const auto integral = [&](double rise, double fall) {
      const double turns = 2 * M_PI * n;
      return (std::polar(1.0, -turns * rise) - std::polar(1.0, -turns * fall)) /
             std::complex<double>(0.0, turns);
    };
    std::complex<double> expected = 0.0, expected_sampled = 0.0;
    for (const OnInterval& on : switching.on_intervals())
      expected += switching.level() * integral(on.rise, on.fall);
    for (std::size_t k = 0; k < cells.size(); ++k)
      expected_sampled +=
          sampled.samples()[static_cast<Eigen::Index>(k)] * integral(cells[k].rise, cells[k].fall);
    EXPECT_LT(std::abs(of_switching[n] - expected), 1e-14) << n;
    EXPECT_LT(std::abs(of_sampled[n] - expected_sampled), 1e-14) << n;
  }
}

TEST(Waveform, ComplementAddsToOneEverywhere) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    Waveform w = random_binary(i);
    w = Waveform::binary(w.on_intervals());
    const Eigen::VectorXd sum = w.cell_averages(97) + w.complement().cell_averages(97);
    EXPECT_LT((sum.array() - 1.0).abs().maxCoeff(), 1e-12);
  }
  EXPECT_EQ(Waveform::constant(1.0).complement(), Waveform::constant(0.0));
  EXPECT_EQ(Waveform::constant(0.0).complement(), Waveform::constant(1.0));
}

TEST(Waveform, DelayRotatesHarmonicsOnly) {
  const Waveform w = random_binary(5);
  const Eigen::VectorXcd before = w.harmonics(4), after = w.delayed(0.37).harmonics(4);
  for (int n = 0; n <= 4; ++n)
    EXPECT_LT(std::abs(after[n] - before[n] * std::polar(1.0, -2 * M_PI * n * 0.37)), 1e-12);
}

TEST(Waveform, SamplesAndSwitchingTimesAgree) {
  Eigen::VectorXd samples(8);
  samples << 1, 0, 0, 1, 1, 0, 1, 1;
  const Waveform w = Waveform::binary_from_samples(samples, 1.0);
  EXPECT_EQ(w.on_intervals().size(), 2u);
  EXPECT_EQ(w.cell_averages(8), samples);
  EXPECT_EQ(w.edges(), 4);
}

TEST(Waveform, RejectsUnsortedSwitchingTimes) {
  EXPECT_THROW(Waveform::binary({{0.5, 0.7}, {0.1, 0.2}}), std::invalid_argument);
  EXPECT_THROW(Waveform::binary({{0.1, 0.4}, {0.3, 0.6}}), std::invalid_argument);
  EXPECT_THROW(Waveform::binary({{-0.1, 0.4}}), std::invalid_argument);
  EXPECT_THROW(Waveform::binary({{0.2, 0.2}}), std::invalid_argument);
  EXPECT_THROW(Waveform::binary({{0.8, 1.3}, {0.9, 1.0}}), std::invalid_argument);
}

TEST(CodeSet, RejectsInvalidCodes) {
  const Waveform half = square_wave(1, 0.0);
  const auto create = [&](Waveform m, Waveform d) {
    return CodeSet::create("x", 60, 1, {std::move(m)}, {std::move(d)});
  };
  EXPECT_NO_THROW(create(rectangular_pulse(0.1), half));
  EXPECT_THROW(create(Waveform::constant(1.1), half), std::invalid_argument);
  EXPECT_THROW(create(rectangular_pulse(0.1), Waveform::constant(1.2)), std::invalid_argument);
  EXPECT_THROW(
      create(rectangular_pulse(0.1), Waveform::sampled(Eigen::VectorXd::Constant(60, -0.1))),
      std::invalid_argument);
  EXPECT_THROW(create(Waveform::sampled(Eigen::VectorXd::Ones(59)), half), std::invalid_argument);
  EXPECT_THROW(CodeSet::create("x", 60, 2, {rectangular_pulse(0.1)}, {half, half}),
               std::invalid_argument)
      << "an electron cannot go to both taps";
}

}  // namespace

}  // namespace tofsmith

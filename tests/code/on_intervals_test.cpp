// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/on_intervals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace tofsmith {
namespace {

RemainingTime watched(const std::function<double(double)>& fraction_at, double end_s) {
  RemainingTime time;
  for (int i = 0; i <= 10 * end_s; ++i) time.add(0.1 * i, fraction_at(0.1 * i));
  return time;
}

TEST(RemainingTime, OfSteadyWorkIsExact) {
  const auto steady = [](double s) { return s / 50.0; };
  for (const double s : {3.0, 10.0, 25.0, 49.0})
    EXPECT_NEAR(watched(steady, s).seconds().value(), 50.0 - s, 0.5) << s;
}

TEST(RemainingTime, IsUnknownAtTheBeginning) {
  EXPECT_FALSE(RemainingTime().seconds());
  EXPECT_FALSE(watched([](double s) { return s / 10.0; }, 2.0).seconds());
  EXPECT_FALSE(watched([](double s) { return s / 3600.0; }, 20.0).seconds());
  EXPECT_NEAR(watched([](double s) { return s / 3600.0; }, 60.0).seconds().value(), 3540.0, 5.0);
}

TEST(RemainingTime, IsUnknownWhileTheSpeedChanges) {
  // The first 10 % take one second, the rest a hundred.
  const auto fast_first = [](double s) {
    return s < 1.0 ? 0.1 * s : 0.1 + 0.9 * (s - 1.0) / 100.0;
  };
  EXPECT_FALSE(watched(fast_first, 4.0).seconds());
  EXPECT_NEAR(watched(fast_first, 40.0).seconds().value(), 61.0, 1.0);
}

TEST(RemainingTime, OfStalledWorkIsUnknown) {
  EXPECT_FALSE(watched([](double) { return 0.0; }, 100.0).seconds());
  EXPECT_FALSE(watched([](double s) { return s < 10.0 ? 0.05 * s : 0.5; }, 60.0).seconds());
}

TEST(RemainingTime, DecreasesSmoothlyIfStepsDifferSlightly) {
  // Steps take 0.8 s and 1.2 s in turn.
  const auto uneven = [](double s) {
    const double in_pair = s - 2.0 * static_cast<int>(s / 2.0);
    const double steps = in_pair < 0.8 ? in_pair / 0.8 : 1.0 + (in_pair - 0.8) / 1.2;
    return (2.0 * static_cast<int>(s / 2.0) + steps) / 100.0;
  };
  for (double s = 10.0; s < 90.0; s += 0.7)
    EXPECT_NEAR(watched(uneven, s).seconds().value(), 100.0 - s, 0.1 * (100.0 - s) + 0.5) << s;
}

}  // namespace
}  // namespace tofsmith

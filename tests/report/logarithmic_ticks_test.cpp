// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/logarithmic_ticks.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "german_locale.hpp"

namespace tofsmith::plotly {
namespace {

TEST(LogarithmicTicks, AreRoundFewAndInsideWhateverTheRange) {
  for (double low = 1.1e-4; low < 2e4; low *= 3.7) {
    for (const double ratio : {1.05, 1.3, 2.0, 5.0, 9.9, 30.0, 1e4}) {
      const std::vector<Tick> ticks = logarithmic_ticks({low, low * ratio});
      EXPECT_GE(ticks.size(), 2u) << low << " " << ratio;
      EXPECT_LE(ticks.size(), 9u) << low << " " << ratio;
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.value, low * 0.99) << ratio;
        EXPECT_LE(tick.value, low * ratio * 1.01) << ratio;
      }
    }
  }
}

TEST(LogarithmicTicks, EndWhereTheRangeIsRounding) {
  const double low = 0.0888;
  for (const double high : {low, std::nextafter(low, 1.0), low * (1 + 1e-15), low * (1 + 1e-9)})
    EXPECT_LE(logarithmic_ticks({low, high}).size(), 9u) << high - low;
}

TEST(LogarithmicTicks, AreOneTwoAndFiveTimesPowersOfTen) {
  const std::vector<Tick> ticks = logarithmic_ticks({0.0091, 0.083});
  ASSERT_EQ(ticks.size(), 3u);
  EXPECT_EQ(ticks[0].text, "0.01");
  EXPECT_EQ(ticks[1].text, "0.02");
  EXPECT_EQ(ticks[2].text, "0.05");
}

TEST(LogarithmicTicks, WithinAFactorOfFiveAreMultiplesOfOneStep) {
  const std::vector<Tick> ticks = logarithmic_ticks({0.031, 0.083});
  ASSERT_EQ(ticks.size(), 5u);
  for (std::size_t i = 0; i < ticks.size(); ++i)
    EXPECT_DOUBLE_EQ(ticks[i].value, 0.01 * (static_cast<double>(i) + 4));
}

TEST(LogarithmicTicks, AreTheSameInEveryLocale) {
  const GermanLocale locale;
  const std::vector<Tick> ticks = logarithmic_ticks({1.25, 1.75});
  ASSERT_FALSE(ticks.empty());
  for (const Tick& tick : ticks) EXPECT_EQ(fmt::format("{:.6g}", tick.value), tick.text);
}

}  // namespace
}  // namespace tofsmith::plotly

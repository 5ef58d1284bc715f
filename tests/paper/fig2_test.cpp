// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "figure_checks.hpp"

namespace tofsmith {
namespace {

using namespace test;

class Fig2 : public testing::Test {
 protected:
  static const Reproduction& made() {
    static const Reproduction reproduction = coarsely("fig2");
    return reproduction;
  }
  /// Row `row` of an array (3, 240) of the data.
  static std::vector<double> pair_row(const std::string& name, std::size_t row) {
    const std::vector<double> all = values_of(made(), "pairs_" + name, {3, 240});
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(240 * row);
    return {begin, begin + 240};
  }
};

TEST_F(Fig2, FactorizesEveryTargetTriviallyBeyondThePeak) {
  EXPECT_EQ(verdict_on(made(), "trivial factorization: an impulse"), Verdict::holds);
  EXPECT_EQ(verdict_on(made(), "breaks the peak"), Verdict::holds);
  EXPECT_DOUBLE_EQ(std::ranges::max(pair_row("modulation", 0)), 240.0);
  EXPECT_THAT(pair_row("correlation", 0),
              testing::Pointwise(testing::DoubleNear(1e-12), pair_row("target", 0)));
}

TEST_F(Fig2, DesignsWithinThePeakWhatReachesTheTarget) {
  EXPECT_EQ(verdict_on(made(), "keep the limits"), Verdict::holds);
  EXPECT_NEAR(std::ranges::max(pair_row("modulation", 1)), 12.0, 1e-9);
  EXPECT_THAT(pair_row("correlation", 1),
              testing::Pointwise(testing::DoubleNear(1e-9), pair_row("target", 1)));
}

TEST_F(Fig2, SmoothsWhatTheArmsAreTold) {
  const auto nominal = pair_row("modulation", 2), actual = pair_row("modulation_output", 2);
  EXPECT_NEAR(std::ranges::max(nominal), 15.0, 1e-9);
  EXPECT_LT(std::ranges::max(actual), 14.0);
  EXPECT_GT(std::ranges::count_if(actual, [](double v) { return v > 0.5 && v < 11.0; }), 10);
}

TEST_F(Fig2, NeedsTotalVariationForNearBinaryAndProjectionForBinaryWaveforms) {
  EXPECT_NE(verdict_on(made(), "solutions fluctuate"), Verdict::fails);
  EXPECT_EQ(verdict_on(made(), "near-binary"), Verdict::holds);
  EXPECT_EQ(verdict_on(made(), "they are binary"), Verdict::holds);
  EXPECT_EQ(values_of(made(), "ablation_modulation", {6, 240}).size(), 1440u);
}

TEST_F(Fig2, MakesAPage) {
  const std::string page = rendered("fig2", made());
  EXPECT_THAT(page, testing::HasSubstr("Trivial factorization"));
  EXPECT_THAT(page, testing::HasSubstr("One start, three variants"));
}

}  // namespace
}  // namespace tofsmith

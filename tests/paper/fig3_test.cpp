// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "figure_checks.hpp"

namespace tofsmith {
namespace {

using namespace test;

class Fig3 : public testing::Test {
 protected:
  static const Reproduction& made() {
    static const Reproduction reproduction = coarsely("fig3");
    return reproduction;
  }
};

TEST_F(Fig3, ReachesZeroErrorFromPeakSixWithAPulseOfOneSixth) {
  EXPECT_EQ(verdict_on(made(), "zero error from p = 6"), Verdict::holds);
  EXPECT_EQ(verdict_on(made(), "only a peak of 6"), Verdict::holds);
  const auto modulation = values_of(made(), "k3_code1_modulation", {7, 240});
  for (const std::size_t peak : {0u, 1u, 2u}) {  // p = 30, 15, 6
    const auto begin = modulation.begin() + static_cast<std::ptrdiff_t>(240 * peak);
    EXPECT_EQ(std::count_if(begin, begin + 240, [](double v) { return v > 5.999; }), 40);
    EXPECT_EQ(std::count_if(begin, begin + 240, [](double v) { return v < 0.001; }), 200);
  }
}

TEST_F(Fig3, EndsWithSquareAndSquare) {
  EXPECT_EQ(verdict_on(made(), "At p = 2"), Verdict::holds);
  const auto residuals = values_of(made(), "residuals_k3", {3, 7});
  for (const std::size_t code : {0u, 1u, 2u}) EXPECT_NEAR(residuals[7 * code + 6], 0.1925, 5e-4);
}

TEST_F(Fig3, LosesLittleBelowPeakSix) {
  EXPECT_EQ(verdict_on(made(), "grows slowly"), Verdict::holds);
  const auto residuals = values_of(made(), "residuals_k3", {3, 7});
  EXPECT_LT(residuals[3], 0.032);  // p = 5
  EXPECT_LT(residuals[4], 0.070);  // p = 4
  EXPECT_LT(residuals[5], 0.121);  // p = 3
}

TEST_F(Fig3, ReachesZeroErrorExactlyWhereThePeakMeetsTheWalk) {
  EXPECT_EQ(verdict_on(made(), "K = 4 and 5"), Verdict::holds);
  const auto k4 = values_of(made(), "residuals_k4", {4, 7});
  const auto k5 = values_of(made(), "residuals_k5", {5, 7});
  EXPECT_LT(k4[1], 1e-6);  // p = 15
  EXPECT_GT(k4[2], 0.05);  // p = 6
  EXPECT_LT(k5[0], 1e-6);  // p = 30
  EXPECT_GT(k5[1], 0.05);  // p = 15
}

TEST_F(Fig3, MakesAPage) {
  EXPECT_THAT(rendered("fig3", made()), testing::HasSubstr("K = 5, code 5"));
  EXPECT_EQ(std::ranges::count(made().files.at("residuals.csv"), '\n'), 1 + 12 * 7);
}

}  // namespace
}  // namespace tofsmith

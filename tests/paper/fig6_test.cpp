// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "figure_checks.hpp"

namespace tofsmith {
namespace {

using namespace test;

class Fig6 : public testing::Test {
 protected:
  static const Reproduction& made() {
    static const Reproduction reproduction = coarsely("fig6");
    return reproduction;
  }
};

TEST_F(Fig6, TellsBinaryInputsAndPlaysSmoothOutputs) {
  EXPECT_EQ(verdict_on(made(), "inputs are binary"), Verdict::holds);
  EXPECT_EQ(verdict_on(made(), "outputs, smoothed"), Verdict::holds);
  const auto actual = values_of(made(), "codes_demodulation_output", {5, 240});
  double steepest = 0.0;
  for (std::size_t n = 0; n + 1 < 240; ++n)
    steepest = std::max(steepest, std::abs(actual[n + 1] - actual[n]));
  EXPECT_LT(steepest, 0.1);
  EXPECT_GT(std::ranges::max(actual), 0.95);
}

TEST_F(Fig6, FollowsTheTargetsThatTheBandHolds) {
  EXPECT_NE(verdict_on(made(), "resemble"), Verdict::fails);
  const auto chi = values_of(made(), "codes_correlation", {5, 240});
  const auto target = values_of(made(), "codes_target", {5, 240});
  double square = 0.0;
  for (std::size_t n = 0; n < 240; ++n) square += (chi[n] - target[n]) * (chi[n] - target[n]);
  EXPECT_LT(std::sqrt(square / 240), 0.11);  // code 1
}

TEST_F(Fig6, MakesAPage) {
  EXPECT_THAT(rendered("fig6", made()), testing::HasSubstr("Inputs and outputs"));
}

}  // namespace
}  // namespace tofsmith

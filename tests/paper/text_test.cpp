// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <numeric>

#include "figure_checks.hpp"

namespace tofsmith {
namespace {

using namespace test;

class Text : public testing::Test {
 protected:
  static const Reproduction& made() {
    static const Reproduction reproduction = coarsely("text");
    return reproduction;
  }
};

TEST_F(Text, CountsTheIterationsOfEveryStart) {
  EXPECT_NE(verdict_on(made(), "5-50 iterations"), Verdict::fails);
  EXPECT_NE(verdict_on(made(), "3-20 iterations"), Verdict::fails);
  for (const char* cameras : {"unlimited", "band_limited"})
    for (const char* rule : {"tolerance_1e-4", "tolerance_1e-6", "feedback"}) {
      const auto shares =
          values_of(made(), std::string("iterations_") + cameras + "_" + rule, {100});
      EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-9);
    }
}

TEST_F(Text, FindsSinusoidsIndependentOfKOnlyWithoutReadNoise) {
  EXPECT_EQ(verdict_on(made(), "for every K"), Verdict::in_part);
}

TEST_F(Text, FindsBoundsKeptBySmoothing) {
  EXPECT_EQ(verdict_on(made(), "keep the bounds"), Verdict::holds);
}

TEST_F(Text, FindsZeroErrorOfEverySchemeAtPeakThirty) {
  EXPECT_EQ(verdict_on(made(), "At p = 30"), Verdict::holds);
}

TEST_F(Text, MakesAPage) {
  EXPECT_THAT(rendered("text", made()), testing::HasSubstr("Histogram over starts"));
}

}  // namespace
}  // namespace tofsmith

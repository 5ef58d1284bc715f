// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

TEST(Units, RangeIsHalfTheDistanceThatLightTravelsInOnePeriod) {
  EXPECT_NEAR(unambiguous_range_m(15e6), 9.99308193, 1e-8);
}

TEST(Wrap, ReturnsAValueInThePeriodShiftedByWholePeriods) {
  for (std::uint32_t i = 0; i < 500; ++i) {
    RandomStream random(2, i);
    const double period = 0.1 + 10 * random.uniform();
    const double position = (random.uniform() - 0.5) * 200;
    const double wrapped = wrap(position, period);
    EXPECT_GE(wrapped, 0.0);
    EXPECT_LT(wrapped, period);
    const double periods = (position - wrapped) / period;
    EXPECT_NEAR(periods, std::round(periods), 1e-9);
  }
  EXPECT_EQ(wrap(1.0, 1.0), 0.0);
  EXPECT_EQ(wrap(-1e-300, 1.0), 0.0) << "rounding must not give the end point";
}

TEST(CircularDifference, IsTheSignedShortestDifference) {
  EXPECT_NEAR(circular_difference(0.1, 9.9, 10.0), 0.2, 1e-12);
  EXPECT_NEAR(circular_difference(9.9, 0.1, 10.0), -0.2, 1e-12);
  EXPECT_NEAR(circular_difference(7.0, 2.0, 10.0), -5.0, 1e-12);
  EXPECT_EQ(circular_difference(3.0, 3.0, 10.0), 0.0);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/shared/text_numbers.hpp"

namespace tofsmith {
namespace {

TEST(NumberText, NumbersAreNeverInScientificNotation) {
  for (double value = 1e-12; value < 1e15; value *= 7.3)
    for (const double sign : {-1.0, 1.0})
      EXPECT_EQ(plain_number(sign * value, 4).find('e'), std::string::npos) << value;
  EXPECT_EQ(plain_number(1750.0, 3), "1750");
  EXPECT_EQ(plain_number(175312.4, 4), "175312");
  EXPECT_EQ(plain_number(0.0, 1), "0");
  EXPECT_EQ(plain_number(std::numeric_limits<double>::infinity(), 3), "inf");
  EXPECT_EQ(plain_number(std::nan(""), 3), "nan");
}

TEST(NumberText, NumbersKeepTheirDigits) {
  for (double value = 1e-5; value < 1e6; value *= 1.7)
    EXPECT_NEAR(number_in(plain_number(value, 4)).value(), value, 0.5001e-3 * value) << value;
}

TEST(NumberText, LengthsHaveASuitableUnit) {
  EXPECT_EQ(length_text(12.3e-6), "12.3 um");
  EXPECT_EQ(length_text(0.0653), "65.3 mm");
  EXPECT_EQ(length_text(-0.9), "-900 mm");
  EXPECT_EQ(length_text(1.25), "1.25 m");
  EXPECT_EQ(length_text(1750.0), "1750 m");
}

TEST(NumberText, EstimatesIncludeTheirStandardError) {
  EXPECT_EQ(estimate_mm_text({0.061234, 0.00045}), "61.23 ± 0.45");
  EXPECT_EQ(estimate_mm_text({1.7531, 0.121}), "1753 ± 121");
  EXPECT_EQ(estimate_text({74.985e6, 12.4e3}, 1e6), "74.985 ± 0.012");
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/range.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "german_locale.hpp"

namespace tofsmith {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(Range, ContainsTheNumbersOfItsText) {
  struct Case {
    Range range;
    std::string text;
    std::vector<double> inside, outside;
  };
  const std::vector<Case> cases = {
      {Range(), "a number", {-infinity, 0.0, infinity, not_a_number}, {}},
      {finite(), "finite", {-1e300, 0.0, 1e300}, {-infinity, infinity, not_a_number}},
      {at_least(0), "finite and >= 0", {0.0, 1e300}, {-1e-300, infinity, not_a_number}},
      {above(0), "finite and > 0", {1e-300}, {0.0, infinity, not_a_number}},
      {at_least(0).or_infinity(), ">= 0", {0.0, infinity}, {-1.0, -infinity, not_a_number}},
      {closed(1e-7, 0.5), "in [1e-07, 0.5]", {1e-7, 0.5}, {0.0, 0.51, not_a_number}},
      {open(0, 0.5), "in (0, 0.5)", {0.49}, {0.0, 0.5}},
      {right_open(0, 1), "in [0, 1)", {0.0, 0.99}, {-0.1, 1.0}},
      {left_open(0, 1), "in (0, 1]", {0.01, 1.0}, {0.0, 1.1}},
  };
  for (const Case& each : cases) {
    EXPECT_EQ(each.range.text(), each.text);
    for (const double value : each.inside) EXPECT_TRUE(each.range.contains(value)) << each.text;
    for (const double value : each.outside) EXPECT_FALSE(each.range.contains(value)) << each.text;
  }
  EXPECT_EQ(at_least(1).text(true), ">= 1") << "integers are finite";
}

TEST(Range, HasTheSameTextInEveryLocale) {
  const GermanLocale locale;
  EXPECT_EQ(closed(0.01, 100).text(), "in [0.01, 100]");
}

}  // namespace
}  // namespace tofsmith

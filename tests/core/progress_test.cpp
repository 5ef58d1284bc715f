// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

TEST(Progress, PartsOfPartsCoverTheWhole) {
  std::vector<double> seen;
  const Progress whole = [&](double fraction, std::string_view step) {
    EXPECT_EQ(step, "x");
    seen.push_back(fraction);
    return true;
  };
  const Progress second_half = part_of(whole, 0.5, 1.0);
  report(second_half, 0.0, "x");
  report(part_of(second_half, 0.5, 1.0), 0.5, "x");
  report(second_half, 1.0, "x");
  EXPECT_EQ(seen, (std::vector<double>{0.5, 0.875, 1.0}));
}

TEST(Progress, StopsWorkWhenItSaysSo) {
  const Progress stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(report(stop, 0.0, "x"), Interrupted);
  EXPECT_THROW(report(part_of(stop, 0.0, 0.5), 0.0, "x"), Interrupted);
}

TEST(Progress, NoneIsAskedForNothing) {
  EXPECT_NO_THROW(report({}, 0.0, "x"));
  EXPECT_FALSE(part_of({}, 0.0, 1.0));
}

}  // namespace
}  // namespace tofsmith

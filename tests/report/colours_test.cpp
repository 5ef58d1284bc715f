// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace tofsmith {
namespace {

std::pair<std::string, Dash> look(const LineStyle& style) { return {style.colour, style.dash}; }

TEST(ColourAssignment, GivesANameTheSameStyleEveryTime) {
  ColourAssignment colours;
  const auto first = look(colours.style("hamiltonian-k4"));
  for (int i = 0; i < 20; ++i) colours.style("other " + std::to_string(i));
  EXPECT_EQ(look(colours.style("hamiltonian-k4")), first);
}

TEST(ColourAssignment, DependsOnTheOrderOfFirstUseOnly) {
  ColourAssignment a, b;
  for (const char* name : {"one", "two", "one", "three"}) a.style(name);
  for (const char* name : {"one", "two", "three"}) b.style(name);
  for (const char* name : {"three", "two", "one"})
    EXPECT_EQ(look(a.style(name)), look(b.style(name)));
}

TEST(ColourAssignment, DistinguishesTwentyEightNames) {
  ColourAssignment colours;
  std::set<std::pair<std::string, Dash>> looks;
  for (int i = 0; i < 28; ++i) looks.insert(look(colours.style(std::to_string(i))));
  EXPECT_EQ(looks.size(), 28u);
}

}  // namespace
}  // namespace tofsmith

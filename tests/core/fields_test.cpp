// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

struct Inner {
  double share = 0.5;
  int tries = 8;
};
auto fields_of(ConstOrNot<Inner> auto& i) {
  return std::tuple(Field("share", i.share, left_open(0, 0.5)),
                    Field("tries", i.tries, at_least(1), ByEffort{3}));
}

struct Whole {
  int starts = 20;
  std::vector<double> delays_m = {1.0};
  std::optional<double> longest_m;
  std::string name;
  Inner inner;
  std::optional<Inner> second;
};
auto fields_of(ConstOrNot<Whole> auto& w) {
  return std::tuple(Field("starts", w.starts, closed(2, 4e9), ByEffort{2}),
                    Field("delays_m", w.delays_m, above(0)),
                    Field("longest_m", w.longest_m, above(0).or_infinity()), Field("name", w.name),
                    Field("inner", w.inner), Field("second", w.second));
}
static_assert(lists_every_field<Inner> && lists_every_field<Whole>);

// An omitted field of any kind, at any position, is detected at compile time.
struct ForgetsTheLast {
  int starts = 1;
  std::optional<Inner> second;
};
auto fields_of(ConstOrNot<ForgetsTheLast> auto& f) { return std::tuple(Field("starts", f.starts)); }
static_assert(!lists_every_field<ForgetsTheLast>);

struct ForgetsTheFirst {
  double low = 0.0, high = 1.0;
};
auto fields_of(ConstOrNot<ForgetsTheFirst> auto& f) { return std::tuple(Field("high", f.high)); }
static_assert(!lists_every_field<ForgetsTheFirst>);

struct ForgetsAStruct {
  int starts = 1;
  Inner inner;
  std::string name;
};
auto fields_of(ConstOrNot<ForgetsAStruct> auto& f) {
  return std::tuple(Field("starts", f.starts), Field("name", f.name));
}
static_assert(!lists_every_field<ForgetsAStruct>);

struct ListsInAnotherOrder {
  int starts = 1;
  std::string name;
};
auto fields_of(ConstOrNot<ListsInAnotherOrder> auto& f) {
  return std::tuple(Field("name", f.name), Field("starts", f.starts));
}
static_assert(!lists_every_field<ListsInAnotherOrder>);

namespace {

using testing::ElementsAre;

std::string refusal(const Whole& whole) {
  try {
    check_fields(whole, "Whole::");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Fields, AreVisitedByNameInOrder) {
  const Whole whole;
  std::vector<std::string> names;
  for_each_field(whole, [&](const auto& field) { names.emplace_back(field.name); });
  EXPECT_THAT(names, ElementsAre("starts", "delays_m", "longest_m", "name", "inner", "second"));
}

TEST(Fields, MessagesContainOwnerFieldValueAndRule) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({.starts = 1}), "Whole::starts = 1; must be in [2, 4000000000]");
  EXPECT_EQ(refusal({.delays_m = {1.0, infinity}}),
            "Whole::delays_m = inf; each must be finite and > 0");
  EXPECT_EQ(refusal({.longest_m = 0.0}), "Whole::longest_m = 0; must be > 0");
}

TEST(Fields, EffortScalesMarkedCountsOnly) {
  Whole whole;
  scale_by_effort(whole, 0.25);
  EXPECT_EQ(whole.starts, 5);
  EXPECT_EQ(whole.inner.tries, 3) << "no less than it must stay";
  EXPECT_EQ(whole.inner.share, 0.5);
  scale_by_effort(whole, 10);
  EXPECT_EQ(whole.starts, 50);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/enum_words.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tofsmith {
namespace {

enum class Fruit { apple, pear, plum };
constexpr EnumWords<Fruit, 3> fruit_words("Fruit", "fruit", "apple", "pear", "plum");

enum class Nut { hazel };
constexpr EnumWords<Nut, 1> nut_words("Nut", "nut", "hazel");

TEST(EnumWords, EveryValueIsReadBackFromItsWord) {
  for (const Fruit fruit : {Fruit::apple, Fruit::pear, Fruit::plum})
    EXPECT_EQ(fruit_words.parse(fruit_words.of(fruit)), fruit);
  EXPECT_EQ(fruit_words.of(Fruit::pear), "pear");
}

TEST(EnumWords, UnknownWordsAndValuesAreRejectedWithTheKnownOnes) {
  const auto message_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_NE(
      message_of([] { fruit_words.parse("fig"); }).find("fruit = fig; must be apple, pear or plum"),
      std::string::npos);
  EXPECT_NE(message_of([] {
              fruit_words.of(static_cast<Fruit>(3));
            }).find("Fruit = 3; must be in [0, 2]"),
            std::string::npos);
  EXPECT_EQ(message_of([] { nut_words.parse("fig"); }), "nut = fig; must be hazel");
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/text_numbers.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "german_locale.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {
namespace {

TEST(TextNumbers, RequireTheWholeText) {
  EXPECT_EQ(number_in("0.00123"), 0.00123);
  EXPECT_EQ(number_in("-1.5e3"), -1500.0);
  EXPECT_EQ(number_in("+2"), 2.0);
  for (const char* none : {"", "+", "1,5", "1.5 ", " 1.5", "0x10", "1e999", "+-1", "++1", "a"})
    EXPECT_EQ(number_in(none), std::nullopt) << none;
  std::string_view text = "0.25/4";
  EXPECT_EQ(take_number(text), 0.25);
  EXPECT_EQ(text, "/4");
}

TEST(TextNumbers, UseADecimalPointInEveryLocale) {
  const GermanLocale locale;
  char text[16];
  std::snprintf(text, sizeof(text), "%.1f", 1.5);
  ASSERT_STREQ(text, "1,5") << "what the C library writes";
  EXPECT_EQ(number_in("0.00123"), 0.00123);
  EXPECT_EQ(number_in("0,00123"), std::nullopt);
}

TEST(TextNumbers, MessagesAreTheSameInEveryLocale) {
  const GermanLocale locale;
  EXPECT_EQ(broken("samples", 123456, "must be fewer").text(), "samples = 123456; must be fewer");
  EXPECT_EQ(broken("exposure_s", 0.25, "must be less").text(), "exposure_s = 0.25; must be less");
}

TEST(TextNumbers, LettersAreAsciiLetters) {
  EXPECT_EQ(lower_case('I'), 'i');
  EXPECT_EQ(upper_case('i'), 'I');
  EXPECT_TRUE(is_letter('z') && is_digit('9') && is_letter_or_digit('A'));
  EXPECT_FALSE(is_letter('\xe4') || is_letter('_') || is_digit('a') || is_letter_or_digit('-'));
}

}  // namespace
}  // namespace tofsmith

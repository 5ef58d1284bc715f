// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/shared/random.hpp"
#include "core/shared/text_numbers.hpp"
#include "german_locale.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/range.hpp"

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
  EXPECT_EQ(broken("samples", 123456, "must be fewer").text(), "samples = 123456; must be fewer");
  EXPECT_EQ(broken("exposure_s", 0.25, "must be less").text(), "exposure_s = 0.25; must be less");
  EXPECT_EQ(closed(0.01, 100).text(), "in [0.01, 100]");
}

TEST(TextNumbers, LettersAreAsciiLetters) {
  EXPECT_EQ(lower_case('I'), 'i');
  EXPECT_EQ(upper_case('i'), 'I');
  EXPECT_TRUE(is_letter('z') && is_digit('9') && is_letter_or_digit('A'));
  EXPECT_FALSE(is_letter('\xe4') || is_letter('_') || is_digit('a') || is_letter_or_digit('-'));
}

TEST(UnitText, ConvertsNumbersToTheUnitOfAKey) {
  for (const auto& [text, unit, number] :
       {std::tuple<std::string_view, std::string_view, double>{"20e6", "Hz", 20e6},
        {"20MHz", "Hz", 20e6},
        {" 1.5 GHz ", "Hz", 1.5e9},
        {"2m", "m", 2.0},
        {"5 mm", "m", 0.005},
        {"10 um", "m", 1e-5},
        {"100ns", "s", 100e-9},
        {"2m/s", unit_of_key("velocity_m_per_s"), 2.0},
        {"30 cm/s", unit_of_key("velocity_m_per_s"), 0.3},
        {"20klx", "klx", 20.0},
        {"20000 lux", "klx", 20.0},
        {"1 GB", "MB", 1000.0},
        {"45deg", "degrees", 45.0},
        {"+3", "m", 3.0},
        {"1e4", "", 1e4}})
    EXPECT_DOUBLE_EQ(number_in_unit(text, unit).value_or(-1.0), number) << text;
}

TEST(UnitText, RejectsOtherUnitsAndText) {
  for (const auto& [text, unit] : {std::pair<std::string_view, std::string_view>{"20kg", "m"},
                                   {"20MHz", "s"},
                                   {"2m", ""},
                                   {"many", "m"},
                                   {"", "m"},
                                   {"2 m m", "m"},
                                   {"0,02", "m"}})
    EXPECT_FALSE(number_in_unit(text, unit)) << text;
}

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

struct Clock {
  double frequency_hz = 1e6;
  int ticks = 3;
};
void describe(FieldVisitor& fields, Clock& clock) {
  fields.value(Key("frequency_hz", "Frequency", above(0)).usually(1e5, 1e8), clock.frequency_hz);
  fields.value(Key("ticks", "Ticks", at_least(0)), clock.ticks);
}

TEST(UnusualNumbers, AreThoseMoreThanTenTimesOutsideTheUsualRange) {
  for (const double usual : {1e4, 1e6, 1e9}) EXPECT_TRUE(unusual_numbers(Clock{usual, 3}).empty());
  EXPECT_THAT(unusual_numbers(Clock{100.0, 1'000'000}),
              testing::ElementsAre(
                  "frequency_hz = 100 Hz; most cameras have 100000 to 1e+08 Hz; check the unit"));
  EXPECT_EQ(unusual_numbers(Clock{1.1e9, 3}).size(), 1u);
}

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

enum class Fruit { apple, pear, plum };
constexpr auto words_of(Fruit /*any*/) { return word_list("apple", "pear", "plum"); }

enum class Nut { hazel };
constexpr auto words_of(Nut /*any*/) { return word_list("hazel"); }

TEST(WordsOfEnumerations, EveryValueIsReadBackFromItsWord) {
  for (const Fruit fruit : {Fruit::apple, Fruit::pear, Fruit::plum})
    EXPECT_EQ(parse_word<Fruit>("fruit", name_of(fruit)), fruit);
  EXPECT_EQ(name_of(Fruit::pear), "pear");
}

TEST(WordsOfEnumerations, UnknownWordsAndValuesAreRejectedWithTheKnownOnes) {
  const auto message_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_NE(message_of([] {
              parse_word<Fruit>("fruit", "fig");
            }).find("fruit = fig; must be apple, pear or plum"),
            std::string::npos);
  EXPECT_EQ(message_of([] { name_of(static_cast<Fruit>(3)); }),
            "value of an enumeration = 3; must be in [0, 2]");
  EXPECT_EQ(message_of([] { parse_word<Nut>("nut", "fig"); }), "nut = fig; must be hazel");
}

}  // namespace

}  // namespace tofsmith

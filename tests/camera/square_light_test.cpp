// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/square_light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "camera/common_frequency.hpp"

namespace tofsmith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

auto rejects(const char* key, const char* reason) {
  return ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(key), HasSubstr(reason)));
}

TEST(CommonFrequency, IsTheGreatestCommonDivisor) {
  const auto common_hz = [](std::vector<double> list) {
    return common_frequency_hz(list).value_or(0.0);
  };
  EXPECT_NEAR(common_hz({16e6, 80e6, 120e6}), 8e6, 1e-3);
  EXPECT_NEAR(common_hz({240e6 / 7, 240e6 / 11}), 240e6 / 77, 1.0);
  EXPECT_NEAR(common_hz({20e6, 20000010.0}), 10.0, 1e-3);
  EXPECT_EQ(common_hz({20e6, 20000003.0}), 0.0);
  EXPECT_EQ(common_hz({20e6, 20e6 * 1.41421356237}), 0.0);
}

TEST(SquareLight, DividesItsClock) {
  const SquareLight square{.clock_hz = 96e6, .dividers = std::vector{4, 8, 6}};
  EXPECT_EQ(square.modulation_frequencies_hz(), (std::vector{12e6, 16e6, 24e6}));
  EXPECT_NO_THROW(square.validate());
}

TEST(SquareLight, NamesTheKeyThatBreaksARule) {
  const auto validates = [](SquareLight square) { return [square] { square.validate(); }; };
  EXPECT_THAT(validates({}), rejects("light.frequencies_hz = none", "light.clock_hz"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 8e7, 2e7}}),
              rejects("light.frequencies_hz = 2", "listed once"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 8e7}, .clock_hz = 6e7}),
              rejects("light.frequencies_hz = 8", "at most light.clock_hz"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 80000003.0}}),
              rejects("light.frequencies_hz", "common divisor of at least 10 Hz"));
  EXPECT_THAT(validates({.dividers = std::vector{2, 3}}),
              rejects("light.dividers", "requires light.clock_hz"));
  EXPECT_THAT(validates({.clock_hz = 1e8, .dividers = std::vector{2, 2}}),
              rejects("light.dividers = 2", "listed once"));
  EXPECT_THAT(
      validates({.frequencies_hz = std::vector{2e7}, .clock_hz = 1e8, .dividers = std::vector{2}}),
      rejects("light.dividers = [2]", "together with light.frequencies_hz"));
  EXPECT_THAT(validates({.duty_range = {{0.5, 0.2}}, .frequencies_hz = std::vector{2e7}}),
              rejects("light.duty_range", "smallest < largest"));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/unusual_numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tofsmith {
namespace {

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

TEST(InvalidArgument, StoresFieldValueAndRule) {
  EXPECT_NO_THROW(require(true, "field", 3, "rule"));
  try {
    require(false, "sensor.taps", 17, "must be in [1, 16]");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_EQ(error.field(), "sensor.taps");
    EXPECT_EQ(error.value(), "17");
    EXPECT_EQ(error.rule(), "must be in [1, 16]");
    EXPECT_STREQ(error.what(), "sensor.taps = 17; must be in [1, 16]");
  }
}

TEST(BrokenRule, IsThrownByAFailedCheck) {
  const std::optional<BrokenRule> none, taps = broken("taps", 17, "must be in [1, 16]");
  EXPECT_NO_THROW(require(none));
  EXPECT_EQ(text_of(none), std::nullopt);
  EXPECT_EQ(text_of(taps), "taps = 17; must be in [1, 16]");
  EXPECT_THROW(require(taps), InvalidArgument);
}

TEST(IoError, StoresPlaceAndProblem) {
  const IoError error("camera.toml:3:1", "found 17: expected 1 to 16");
  EXPECT_EQ(error.place(), "camera.toml:3:1");
  EXPECT_EQ(error.problem(), "found 17: expected 1 to 16");
  EXPECT_STREQ(error.what(), "camera.toml:3:1: found 17: expected 1 to 16");
}

TEST(EditDistance, CountsEditsAndTranspositions) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("taps", "tpas"), 1);
  EXPECT_EQ(edit_distance("peak", "peak_factor"), 7);
}

std::string random_word(RandomStream& random) {
  std::string word(random() % 7, 'a');
  for (char& c : word) c = static_cast<char>('a' + random() % 3);
  return word;
}

TEST(EditDistance, IsSymmetricZeroForEqualWordsAndAtMostTheLongerLength) {
  for (std::uint32_t i = 0; i < 300; ++i) {
    RandomStream random(5, i);
    const std::string a = random_word(random), b = random_word(random);
    const int distance = edit_distance(a, b);
    EXPECT_EQ(distance, edit_distance(b, a)) << a << " " << b;
    EXPECT_EQ(distance == 0, a == b) << a << " " << b;
    EXPECT_LE(distance, static_cast<int>(std::max(a.size(), b.size())));
    EXPECT_GE(distance, std::abs(static_cast<int>(a.size()) - static_cast<int>(b.size())));
    EXPECT_LE(edit_distance(a + "x", b), distance + 1);
  }
}

TEST(NearestWord, FindsMisspellingsOnly) {
  const std::array<std::string_view, 3> known{"peak_factor", "read_noise_e", "taps"};
  EXPECT_EQ(nearest_word("peak_facto", known), "peak_factor");
  EXPECT_EQ(nearest_word("tpas", known), "taps");
  EXPECT_EQ(nearest_word("taps", known), "taps");
  EXPECT_EQ(nearest_word("wavelength_nm", known), "");
  EXPECT_EQ(nearest_word("anything", std::array<std::string, 0>{}), "");
}

}  // namespace
}  // namespace tofsmith

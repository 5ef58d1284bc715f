// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/pfm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PfmKind : public testing::TestWithParam<std::tuple<int, PfmByteOrder>> {
 protected:
  PfmImage image() const {
    PfmImage image{3, 4, std::get<0>(GetParam()), 2.5, {}};
    image.values.resize(static_cast<std::size_t>(12 * image.channels));
    std::iota(image.values.begin(), image.values.end(), -3.25f);
    image.values[1] = std::numeric_limits<float>::infinity();
    return image;
  }
  FileBytes file() const { return serialize_pfm(image(), std::get<1>(GetParam())); }
};

TEST_P(PfmKind, ReadingUndoesWriting) {
  const PfmImage back = parse_pfm(file(), "a.pfm");
  EXPECT_EQ(back.height, 3);
  EXPECT_EQ(back.width, 4);
  EXPECT_EQ(back.channels, image().channels);
  EXPECT_EQ(back.scale, 2.5);
  EXPECT_EQ(back.values, image().values);
}

TEST_P(PfmKind, RefusesEveryTruncation) {
  expect_truncations_refused(file(), [](auto bytes) { parse_pfm(bytes, "a.pfm"); });
}

INSTANTIATE_TEST_SUITE_P(GreyAndColour, PfmKind,
                         testing::Combine(testing::Values(1, 3),
                                          testing::Values(PfmByteOrder::little_endian,
                                                          PfmByteOrder::big_endian)));

TEST(Pfm, TheFirstRowOfTheFileIsTheBottomRow) {
  // Two rows of one pixel, big endian: 1.0 below 2.0.
  const PfmImage image =
      parse_pfm(bytes_of(std::string("Pf\n1 2\n1.0\n\x3f\x80\0\0\x40\0\0\0", 19)), "a.pfm");
  EXPECT_THAT(image.values, ElementsAre(2.0f, 1.0f));
  EXPECT_EQ(serialize_pfm(image), bytes_of(std::string("Pf\n1 2\n-1\n\0\0\x80\x3f\0\0\0\x40", 18)));
}

TEST(Pfm, ReportsTheByteOfMalformedHeaders) {
  const auto refusal = [](std::string_view text) {
    return io_error_of([&] { parse_pfm(bytes_of(text), "a.pfm"); });
  };
  EXPECT_THAT(refusal("P6\n1 1\n-1\n1234"), HasSubstr("a.pfm: byte 0: found no PFM magic"));
  EXPECT_THAT(refusal("Pfx1 1\n-1\n1234"), HasSubstr("byte 2"));
  EXPECT_THAT(refusal("Pf\n1.5 1\n-1\n1234"), HasSubstr("the width"));
  EXPECT_THAT(refusal("Pf\n1 -1\n-1\n1234"), HasSubstr("the height"));
  EXPECT_THAT(refusal("Pf\n1 1\n0\n1234"), HasSubstr("scale"));
  EXPECT_THAT(refusal("Pf\n1 1\nnan\n1234"), HasSubstr("scale"));
  EXPECT_THAT(refusal("Pf\n0 1\n-1\n"), HasSubstr("0 pixels"));
  EXPECT_THAT(refusal("Pf\n4000000000 4000000000\n-1\n1234"), HasSubstr("at most"));
  EXPECT_THAT(refusal("Pf\n6000 4000\n-1\n1234"), HasSubstr("found 4 bytes of data"));
  EXPECT_THAT(refusal("Pf\n1 1\n-1\n12345"), HasSubstr("found 5 bytes of data; expected 4"));
  EXPECT_THAT(refusal("Pf\n" + std::string(1000, '1')), HasSubstr("the width"));
}

TEST(Pfm, RejectsWritingInvalidImages) {
  EXPECT_THROW(serialize_pfm(PfmImage{1, 2, 1, 1.0, {1.0f}}), std::invalid_argument);
  EXPECT_THROW(serialize_pfm(PfmImage{1, 1, 2, 1.0, {1.0f, 2.0f}}), std::invalid_argument);
  EXPECT_THROW(serialize_pfm(PfmImage{1, 1, 1, 0.0, {1.0f}}), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/exr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

ExrPlanes test_planes(int height = 5, int width = 6) {
  ExrPlanes planes;
  for (const char* name : {"Z", "confidence"}) {
    Image<float> plane(height, width);
    RandomStream random(6, planes.size());
    for (float& value : plane.pixels) value = static_cast<float>(random.normal());
    plane.pixels[2] = std::numeric_limits<float>::infinity();
    planes[name] = plane;
  }
  return planes;
}

TEST(Exr, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  for (const auto& [height, width] : {std::pair{1, 3}, std::pair{5, 6}, std::pair{70, 33}}) {
    const ExrPlanes planes = test_planes(height, width);
    write_exr(directory / "a.exr", planes, OutputPolicy::overwrite);
    const ExrPlanes back = read_exr(directory / "a.exr");
    ASSERT_EQ(back.size(), 2u);
    for (const auto& [name, plane] : planes) {
      EXPECT_EQ(back.at(name).height, height);
      EXPECT_EQ(back.at(name).width, width);
      EXPECT_EQ(back.at(name).pixels, plane.pixels);
    }
  }
}

TEST(Exr, EqualPlanesGiveEqualBytes) {
  EXPECT_EQ(serialize_exr(test_planes()), serialize_exr(test_planes()));
}

std::string attribute(std::string name, std::string kind, const std::string& value) {
  std::string size(4, '\0');
  size[0] = static_cast<char>(value.size());
  return name + '\0' + kind + '\0' + size + value;
}

/// Returns an uncompressed file of one line with two half-float pixels, 1.0 and -2.0. `type` is the
/// pixel type, `flags` the second version byte, and `more` is appended to the attributes.
FileBytes small_file(char type = 1, char flags = 0,
                     const std::string& window_corner = std::string("\1\0\0\0\0\0\0\0", 8),
                     const std::string& more = "") {
  const std::string window = std::string(8, '\0') + window_corner;
  std::string file = std::string("\x76\x2f\x31\x01\x02", 5) + flags + std::string(2, '\0');
  file +=
      attribute("channels", "chlist",
                std::string("Z\0", 2) + type + std::string("\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0", 16));
  file += attribute("compression", "compression", std::string(1, '\0'));
  file += attribute("dataWindow", "box2i", window);
  file += attribute("displayWindow", "box2i", window);
  file += attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  file += attribute("pixelAspectRatio", "float", std::string("\0\0\x80\x3f", 4));
  file += attribute("screenWindowCenter", "v2f", std::string(8, '\0'));
  file += attribute("screenWindowWidth", "float", std::string("\0\0\x80\x3f", 4));
  file += more + '\0';
  const std::size_t offset = file.size() + 8;
  file += static_cast<char>(offset & 0xff);
  file += static_cast<char>(offset >> 8);
  file += std::string(6, '\0');                // offset of the only line
  file += std::string("\0\0\0\0\4\0\0\0", 8);  // its row and length
  file += std::string("\x00\x3c\x00\xc0", 4);  // 1.0, -2.0
  return bytes_of(file);
}

TEST(Exr, ReadsHalfFloats) {
  const ExrPlanes planes = parse_exr(small_file(), "a.exr");
  EXPECT_THAT(planes.at("Z").pixels, testing::ElementsAre(1.0f, -2.0f));
}

TEST(Exr, RejectsUnsupportedFiles) {
  const auto refusal = [](const FileBytes& file) {
    return io_error_of([&] { parse_exr(file, "a.exr"); });
  };
  EXPECT_THAT(refusal(bytes_of("PNG and more")),
              HasSubstr("a.exr: byte 0: found no OpenEXR magic"));
  EXPECT_THAT(refusal(small_file(0)), HasSubstr("channel 'Z' holds integers"));
  EXPECT_THAT(refusal(small_file(1, 0x08)), HasSubstr("deep"));
  EXPECT_THAT(refusal(small_file(1, 0x10)), HasSubstr("several parts"));
  EXPECT_THAT(refusal(small_file(1, 0x40)), HasSubstr("unknown flags"));
  EXPECT_THAT(refusal(small_file(1, 0, "\xff\xff\xff\x7f\xff\xff\xff\x7f")), HasSubstr("at most"));
  EXPECT_THAT(refusal(small_file(1, 0, std::string("\0\x1f\0\0\0\x1f\0\0", 8))),
              HasSubstr("can unpack to"));
  EXPECT_THAT(refusal(small_file(1, 0, "\xf0\xff\xff\xff\xff\xff\xff\xff")),
              HasSubstr("found an image"));
}

// The OpenEXR library assumes that attributes are as long as their types: other sizes made it
// misinterpret the following bytes and allocate gigabytes for a file of 600 bytes.
TEST(Exr, RejectsAttributesOfOtherSizesThanTheirTypes) {
  const auto refusal = [](const std::string& type, const std::string& value) {
    const FileBytes file =
        small_file(1, 0, std::string("\1\0\0\0\0\0\0\0", 8), attribute("a", type, value));
    return io_error_of([&] { parse_exr(file, "a.exr"); });
  };
  EXPECT_THAT(refusal("v3f", std::string(8, '\0')), HasSubstr("found 8 bytes of type 'v3f'"));
  EXPECT_THAT(refusal("box2i", std::string(20, '\0')), HasSubstr("expected 16"));
  EXPECT_THAT(refusal("preview", std::string("\1\0\0\0\xff\xff\xff\xff", 8)),
              HasSubstr("type 'preview'"));
  EXPECT_THAT(refusal("chlist", std::string(3, '\0')), HasSubstr("expected 1"));
  for (const char* any : {"string", "ours"})
    EXPECT_NO_THROW(parse_exr(
        small_file(1, 0, std::string("\1\0\0\0\0\0\0\0", 8), attribute("a", any, "some words")),
        "a.exr"));
}

TEST(Exr, RefusesEveryTruncation) {
  const FileParser parse = [](auto bytes) { parse_exr(bytes, "a.exr"); };
  expect_truncations_refused(small_file(), parse);
  expect_truncations_refused(serialize_exr(test_planes()), parse);
}

TEST(Exr, RejectsWritingPlanesOfDifferentSizes) {
  EXPECT_THROW(serialize_exr({}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"", Image<float>(1, 1)}}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"Z", Image<float>()}}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"Y", Image<float>(1, 2)}, {"Z", Image<float>(2, 1)}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "damaged_files.hpp"
#include "io/image_limits.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PngImage test_image(int channels, int bit_depth) {
  PngImage image{5, 7, channels, bit_depth, {}};
  RandomStream random(3, static_cast<std::uint64_t>(channels),
                      static_cast<std::uint32_t>(bit_depth));
  image.values.resize(static_cast<std::size_t>(5 * 7 * channels));
  for (auto& value : image.values)
    value = static_cast<std::uint16_t>(random() & static_cast<unsigned>(image.max_value()));
  image.values.back() = static_cast<std::uint16_t>(image.max_value());
  return image;
}

class PngKind : public testing::TestWithParam<std::tuple<int, int>> {
 protected:
  PngImage image() const { return test_image(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(PngKind, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  write_png(directory / "a.png", image(), OutputPolicy::refuse_existing);
  const PngImage back = read_png(directory / "a.png");
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.channels, image().channels);
  EXPECT_EQ(back.bit_depth, image().bit_depth);
  EXPECT_EQ(back.values, image().values);
}

TEST_P(PngKind, RefusesEveryTruncation) {
  expect_truncations_refused(serialize_png(image()), [](auto bytes) { parse_png(bytes, "a.png"); });
}

INSTANTIATE_TEST_SUITE_P(AllKinds, PngKind,
                         testing::Combine(testing::Values(1, 2, 3, 4), testing::Values(8, 16)));

std::string chunk(const std::string& type_and_data) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : type_and_data) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  crc = ~crc;
  const auto word = [](std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
    return text;
  };
  return word(static_cast<std::uint32_t>(type_and_data.size() - 4)) + type_and_data + word(crc);
}

const std::string png_magic = "\x89PNG\r\n\x1a\n";

TEST(Png, ResolvesPalettesAndExpandsSmallBitDepths) {
  // 2 x 1 pixels with a palette of two colours at one bit, in one stored deflate block: 0x40 = 0,
  // 1.
  const std::string palette_file =
      png_magic + chunk(std::string("IHDR\0\0\0\2\0\0\0\1\1\3\0\0\0", 17)) +
      chunk(std::string("PLTE\x0a\x14\x1e\xff\x80\x01", 10)) +
      chunk(std::string("IDAT\x78\x01\x01\x02\x00\xfd\xff\x00\x40\x00\x42\x00\x41", 17)) +
      chunk("IEND");
  const PngImage palette = parse_png(bytes_of(palette_file), "p.png");
  EXPECT_EQ(palette.channels, 3);
  EXPECT_THAT(palette.values, ElementsAre(10, 20, 30, 255, 128, 1));

  const std::string grey_file =
      png_magic + chunk(std::string("IHDR\0\0\0\2\0\0\0\1\1\0\0\0\0", 17)) +
      chunk(std::string("IDAT\x78\x01\x01\x02\x00\xfd\xff\x00\x40\x00\x42\x00\x41", 17)) +
      chunk("IEND");
  const PngImage grey = parse_png(bytes_of(grey_file), "g.png");
  EXPECT_EQ(grey.bit_depth, 8);
  EXPECT_THAT(grey.values, ElementsAre(0, 255));
}

TEST(Png, RejectsImagesLargerThanTheFile) {
  const auto claiming = [](const std::string& sides) {
    return bytes_of(png_magic + chunk("IHDR" + sides + std::string("\x10\0\0\0\0", 5)) +
                    chunk(std::string("IDAT\x78\x01", 6)) + chunk("IEND"));
  };
  EXPECT_THAT(
      io_error_of([&] { parse_png(claiming(std::string("\0\0\x20\0\0\0\x20\0", 8)), "a.png"); }),
      HasSubstr("can unpack to"));
  EXPECT_THAT(
      io_error_of([&] { parse_png(claiming(std::string("\0\0\xf0\0\0\0\xf0\0", 8)), "a.png"); }),
      HasSubstr("at most 67108864 pixels"));
  EXPECT_THROW(parse_png(claiming("\x7f\xff\xff\xff\x7f\xff\xff\xff"), "a.png"), IoError);
}

TEST(Png, RejectsOtherFiles) {
  EXPECT_THAT(io_error_of([] { parse_png(bytes_of("Pf\n1 1\n-1\n1234"), "a.png"); }),
              HasSubstr("a.png: damaged PNG: "));
}

TEST(Png, RejectsWritingInvalidImages) {
  PngImage image = test_image(1, 8);
  image.values[3] = 256;
  EXPECT_THROW(serialize_png(image), std::invalid_argument);
  image.values.pop_back();
  EXPECT_THROW(serialize_png(image), std::invalid_argument);
  EXPECT_THROW(serialize_png(PngImage{}), std::invalid_argument);
  EXPECT_THROW(serialize_png(PngImage{1, 1, 5, 8, {1, 2, 3, 4, 5}}), std::invalid_argument);
  EXPECT_THROW(serialize_png(PngImage{1, 1, 1, 4, {1}}), std::invalid_argument);
}

TEST(Colour, SrgbConversionsAreInverse) {
  for (int i = 0; i <= 255; ++i)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0)), i / 255.0, 1e-6);
  EXPECT_EQ(linear_from_srgb(0.0), 0.0);
  EXPECT_NEAR(linear_from_srgb(1.0), 1.0, 1e-15);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.2140411, 1e-6);
  EXPECT_NEAR(luminance_rec709(1.0, 1.0, 1.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/array_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>

#include "damaged_files.hpp"
#include "io/image_limits.hpp"
#include "io/images/netpbm.hpp"
#include "io/shared/byte_order.hpp"
#include "temporary_directory.hpp"
#include "tiff_writer.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto overwrite = OutputPolicy::overwrite;
constexpr std::size_t height = 40, width = 70;

std::uint16_t number_at(std::size_t row, std::size_t column, int phase = 0) {
  return static_cast<std::uint16_t>(900 * row + (column * column + 7919 * row * column) % 613 +
                                    41 * static_cast<std::size_t>(phase));
}

std::vector<std::uint16_t> phase_image(int phase = 0) {
  std::vector<std::uint16_t> numbers;
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column)
      numbers.push_back(number_at(row, column, phase));
  return numbers;
}

void append(FileBytes& bytes, std::uint16_t number, bool big_endian) {
  const auto low = static_cast<std::byte>(number), high = static_cast<std::byte>(number >> 8);
  bytes.insert(bytes.end(), {big_endian ? high : low, big_endian ? low : high});
}

/// Values outside the image are 0.
FileBytes block_bytes(std::size_t first_row, std::size_t rows, std::size_t first_column,
                      std::size_t columns, bool big_endian, bool differences) {
  FileBytes bytes;
  for (std::size_t row = first_row; row < first_row + rows; ++row) {
    std::uint16_t before = 0;
    for (std::size_t column = first_column; column < first_column + columns; ++column) {
      const auto number =
          row < height && column < width ? number_at(row, column) : std::uint16_t{0};
      append(bytes, static_cast<std::uint16_t>(differences ? number - before : number), big_endian);
      before = number;
    }
  }
  return bytes;
}

FileBytes pack_bits(const FileBytes& bytes) {
  FileBytes packed;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t count = std::min<std::size_t>(100, bytes.size() - at);
    packed.push_back(static_cast<std::byte>(count - 1));
    packed.insert(packed.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(at + count));
    at += count;
    if (at + 3 < bytes.size() && bytes[at] == bytes[at + 1]) {
      packed.insert(packed.end(), {std::byte{0xff}, bytes[at]});  // a run of two
      at += 2;
    }
  }
  return packed;
}

/// Writes a single stored block.
FileBytes pack_deflate(const FileBytes& bytes) {
  FileBytes packed = {std::byte{0x78}, std::byte{0x01}, std::byte{0x01}};
  const auto size = static_cast<std::uint16_t>(bytes.size());
  append(packed, size, false);
  append(packed, static_cast<std::uint16_t>(~size), false);
  packed.insert(packed.end(), bytes.begin(), bytes.end());
  std::uint32_t a = 1, b = 0;
  for (const std::byte byte : bytes) {
    a = (a + std::to_integer<std::uint32_t>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  append(packed, static_cast<std::uint16_t>(b), true);
  append(packed, static_cast<std::uint16_t>(a), true);
  return packed;
}

FileBytes packed_by(int scheme, const FileBytes& bytes) {
  if (scheme == 5) return pack_lzw(bytes);
  if (scheme == 8) return pack_deflate(bytes);
  return scheme == 32773 ? pack_bits(bytes) : bytes;
}

TiffWriter tiff_of(int scheme, bool big_endian, int predictor) {
  return {.big_endian = big_endian,
          .tags = {{256, {width}},
                   {257, {height}},
                   {258, {16}},
                   {259, {static_cast<std::uint32_t>(scheme)}},
                   {262, {1}},
                   {277, {1}},
                   {317, {static_cast<std::uint32_t>(predictor)}}},
          .blocks = {}};
}

TEST(Tiff, ReadsStripsAndTilesOfEveryCompression) {
  for (const int scheme : {1, 5, 8, 32773})
    for (const bool big_endian : {false, true})
      for (const int predictor : {1, 2}) {
        SCOPED_TRACE(testing::Message() << scheme << " " << big_endian << " " << predictor);
        TiffWriter strips = tiff_of(scheme, big_endian, predictor), tiles = strips;
        strips.tags.push_back({278, {32}});
        for (const auto& [first, rows] : {std::pair{0, 32}, std::pair{32, 8}})
          strips.blocks.push_back(
              packed_by(scheme, block_bytes(first, rows, 0, width, big_endian, predictor == 2)));
        const NpyArray image = parse_tiff(strips.file(), "a.tiff");
        EXPECT_THAT(image.shape(), ElementsAre(height, width));
        EXPECT_THAT(image.as<std::uint16_t>(), testing::ElementsAreArray(phase_image()));

        tiles.tags.push_back({322, {32}});
        tiles.tags.push_back({323, {16}});
        for (std::size_t row = 0; row < height; row += 16)
          for (std::size_t column = 0; column < width; column += 32)
            tiles.blocks.push_back(
                packed_by(scheme, block_bytes(row, 16, column, 32, big_endian, predictor == 2)));
        EXPECT_THAT(parse_tiff(tiles.file(324, 325), "a.tiff").as<std::uint16_t>(),
                    testing::ElementsAreArray(phase_image()));
      }
}

TEST(Tiff, RejectsUnsupportedImagesWithTheReason) {
  const auto refusal = [](TiffWriter writer, int tag, std::uint32_t value) {
    for (auto& [number, values] : writer.tags)
      if (number == tag) values = {value};
    return io_error_of([&] { parse_tiff(writer.file(), "a.tiff"); });
  };
  TiffWriter good = tiff_of(1, false, 1);
  good.blocks = {block_bytes(0, height, 0, width, false, false)};
  EXPECT_THAT(refusal(good, 258, 12), HasSubstr("numbers of 12 bits"));
  EXPECT_THAT(refusal(good, 277, 3), HasSubstr("3 numbers per pixel"));
  EXPECT_THAT(refusal(good, 262, 0), HasSubstr("photometric interpretation 0"));
  EXPECT_THAT(refusal(good, 259, 7), HasSubstr("compression 7; expected none, LZW"));
  EXPECT_THAT(refusal(good, 317, 3), HasSubstr("predictor 3"));
  EXPECT_THAT(refusal(good, 257, 41), HasSubstr("found 5600 bytes; expected 5740"));
  EXPECT_THAT(refusal(good, 256, 70000), HasSubstr("70000"));
  good.next_page = 8;
  EXPECT_THAT(refusal(good, 0, 0), HasSubstr("several pages; expected one"));
  EXPECT_THAT(io_error_of([] { parse_tiff(FileBytes(3), "a.tiff"); }), HasSubstr("a.tiff"));
}

TEST(Pgm, ReadsBinaryAndTextOfBothSizes) {
  const std::string wide("P5\n# made by hand\n2 1 4095\n\x0f\xff\x00\x01", 31);
  EXPECT_THAT(parse_pgm(bytes_of(wide), "a.pgm").as<std::uint16_t>(), ElementsAre(4095, 1));
  EXPECT_THAT(parse_pgm(bytes_of("P5 2 1 255 ab"), "a.pgm").as<std::uint8_t>(),
              ElementsAre('a', 'b'));
  EXPECT_THAT(parse_pgm(bytes_of("P2 2 1 4095\n4095 # right\n 7"), "a.pgm").as<std::uint16_t>(),
              ElementsAre(4095, 7));
}

TEST(Pgm, RejectsDamagedFilesWithTheReason) {
  const auto refusal = [](const std::string& text) {
    return io_error_of([&] { parse_pgm(bytes_of(text), "a.pgm"); });
  };
  EXPECT_THAT(refusal("P6 1 1 255 abc"), HasSubstr("expected P5 (binary) or P2 (text)"));
  EXPECT_THAT(refusal("P5 2 1 65535 abc"), HasSubstr("found 3 bytes of data; expected 4"));
  EXPECT_THAT(refusal("P5 2 2 255 abcde"), HasSubstr("found 5 bytes of data; expected 4"));
  EXPECT_THAT(refusal("P5 2 1 0 ab"), HasSubstr("expected 1 to 65535"));
  EXPECT_THAT(refusal("P2 2 1 15 3 16"), HasSubstr("found 16; expected at most 15"));
  EXPECT_THAT(refusal("P2 2 1 15 3 x"), AllOf(HasSubstr("a.pgm"), HasSubstr("number of a pixel")));
}

std::vector<std::filesystem::path> write_phases(const TemporaryDirectory& directory,
                                                const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (int phase = 0; phase < 4; ++phase) {
    files.push_back(directory / ("p" + std::to_string(phase) + extension));
    const std::vector<std::uint16_t> numbers = phase_image(phase);
    if (extension == ".png") {
      write_png(files.back(), {height, width, 1, 16, numbers}, overwrite);
      continue;
    }
    FileBytes pixels;
    for (const std::uint16_t number : numbers) append(pixels, number, true);
    TiffWriter tiff = tiff_of(1, true, 1);
    tiff.blocks = {pixels};
    FileBytes file = extension == ".tif" ? tiff.file() : bytes_of("P5 70 40 65535\n");
    if (extension == ".pgm") file.insert(file.end(), pixels.begin(), pixels.end());
    write_file_atomically(files.back(), file, overwrite);
  }
  return files;
}

TEST(PhaseImages, FormAFrame) {
  const TemporaryDirectory directory;
  for (const std::string extension : {".png", ".tif", ".pgm"}) {
    const RawFrames frames =
        read_raw_frames(write_phases(directory, extension), {.measurements = 4});
    ASSERT_EQ(frames.frames, 1);
    ASSERT_EQ(frames.measurements, 4);
    for (int phase = 0; phase < 4; ++phase)
      for (std::size_t i = 0; i < height * width; ++i)
        ASSERT_EQ(frames.values[4 * i + static_cast<std::size_t>(phase)], phase_image(phase)[i]);
  }
}

TEST(PhaseImages, OfDifferentSizeNumberOrColourAreRejected) {
  const TemporaryDirectory directory;
  auto files = write_phases(directory, ".png");
  const auto refusal = [&] {
    return io_error_of([&] { read_raw_frames(files, {.measurements = 4}); });
  };
  write_png(files[2], {2, 3, 1, 16, std::vector<std::uint16_t>(6)}, overwrite);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("p2.png"), HasSubstr("1 frame of 2 x 3; expected 1 frame "
                                                              "of 40 x 70 as in")));
  write_png(files[2], {height, width, 3, 16, std::vector<std::uint16_t>(3 * height * width)},
            overwrite);
  EXPECT_THAT(refusal(), HasSubstr("found 3 channels; expected a grey image"));
  write_png(files[2], {height, width, 1, 8, std::vector<std::uint16_t>(height * width)}, overwrite);
  EXPECT_THAT(refusal(), HasSubstr("read as uint8 (whole); expected uint16 (whole) as in"));
  files.pop_back();
  EXPECT_THAT(refusal(), HasSubstr("found 3 files, one per measurement; expected 4"));
  files.resize(1);
  EXPECT_THAT(refusal(), HasSubstr("all files if each contains one measurement"));
}

enum class PfmByteOrder { little_endian, big_endian };

class PfmKind : public testing::TestWithParam<std::tuple<int, PfmByteOrder>> {
 protected:
  PfmImage image() const {
    PfmImage image{3, 4, std::get<0>(GetParam()), 2.5, {}};
    image.values.resize(static_cast<std::size_t>(12 * image.channels));
    std::iota(image.values.begin(), image.values.end(), -3.25f);
    image.values[1] = std::numeric_limits<float>::infinity();
    return image;
  }
  FileBytes file() const {
    FileBytes content = serialize_pfm(image());
    if (std::get<1>(GetParam()) == PfmByteOrder::little_endian) return content;
    content.erase(content.begin() + 7);  // the sign of the scale
    swap_byte_order(std::span(content).last(image().values.size() * sizeof(float)), sizeof(float));
    return content;
  }
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

TEST(Colour, LinearLightIsTheInverseOfSrgb) {
  const auto srgb_from_linear = [](double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  };
  for (int i = 0; i <= 255; ++i)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0)), i / 255.0, 1e-6);
  EXPECT_EQ(linear_from_srgb(0.0), 0.0);
  EXPECT_NEAR(linear_from_srgb(1.0), 1.0, 1e-15);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.2140411, 1e-6);
  EXPECT_NEAR(luminance_rec709(1.0, 1.0, 1.0), 1.0, 1e-12);
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>
#include <utility>

#include "damaged_files.hpp"
#include "raw_packer.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RawFormat random_format(RandomStream& random) {
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  RawFormat f;
  f.width = 1 + below(9);
  f.height = 1 + below(5);
  f.measurements = 1 + below(6);
  f.layout = std::array{RawOrder::planar, RawOrder::interleaved,
                        RawOrder::by_rows}[static_cast<std::size_t>(below(3))];
  switch (below(6)) {
    case 0:
      f.numbers = RawNumbers::floats;
      f.bits = 16 << below(3);
      f.byte_order = below(2) == 0 ? RawByteOrder::big : RawByteOrder::little;
      break;
    case 1:
      f.packing = RawPacking::mipi;
      f.bits = 10 + 2 * below(3);
      f.width = 4 * (1 + below(3));
      break;
    case 2:
    case 3:
      f.packing = below(2) == 0 ? RawPacking::lsb_first : RawPacking::msb_first;
      f.bits = 1 + below(32);
      f.rows_start_bytes = below(2) == 0;
      break;
    default:
      f.bits = 1 + below(32);
      if (below(2) == 0) f.container_bits = f.bits <= 8 ? 8 << below(3) : f.bits <= 16 ? 16 : 32;
      f.align = below(2) == 0 ? RawAlignment::low : RawAlignment::high;
      f.byte_order = below(2) == 0 ? RawByteOrder::big : RawByteOrder::little;
  }
  f.is_signed = f.numbers == RawNumbers::integers && below(2) == 0;
  if (f.is_signed && below(2) == 0) f.sign_bit = below(static_cast<unsigned>(f.bits));
  if (f.is_signed && below(2) == 0) f.sign_encoding = SignEncoding::sign_magnitude;
  f.negate_rows = static_cast<NegatedLines>(below(3));
  f.negate_columns = static_cast<NegatedLines>(below(3));
  f.negate_from_row = below(static_cast<unsigned>(f.height));
  f.negate_from_column = below(static_cast<unsigned>(f.width));
  f.header_bytes = below(3) * 7;
  f.trailer_bytes = below(3) * 3;
  f.frame_header_bytes = below(3) * 5;
  f.frame_trailer_bytes = below(3);
  if (f.layout == RawOrder::planar) f.image_header_bytes = below(3);
  if (f.layout == RawOrder::planar) f.image_trailer_bytes = below(3);
  if (f.rows_start_bytes) f.row_header_bytes = below(3);
  if (f.rows_start_bytes && below(2) == 0)
    f.row_bytes = f.row_header_bytes + static_cast<int>(f.tight_row_bytes()) + below(4);
  if (below(2) == 0) {
    f.order.resize(static_cast<std::size_t>(f.measurements), -1);
    std::iota(f.order.begin(), f.order.begin() + 1 + below(static_cast<unsigned>(f.measurements)),
              0);
    for (std::size_t i = f.order.size(); i > 1; --i)
      std::swap(f.order[i - 1], f.order[random() % i]);
    if (f.order.back() == -1) f.order.pop_back();
  }
  f.flip_rows = below(2) == 0;
  f.flip_columns = below(2) == 0;
  f.rotate_deg = 90 * below(4);
  if (f.kept_measurements() % 2 == 0 && below(2) == 0) f.taps = RawTaps::subtract;
  if (!f.subtracts_taps()) f.black_level = below(3) * 16.0;
  f.validate();
  return f;
}

double random_number(const RawFormat& f, RandomStream& random) {
  if (f.numbers == RawNumbers::floats && f.bits == 16)
    return std::floor((random.uniform() - 0.5) * 2048.0) / 1024.0;
  if (f.numbers == RawNumbers::floats)
    return f.bits == 32 ? static_cast<float>(random.uniform() - 0.5) : random.uniform() - 0.5;
  const int bits = f.sign_bit.value_or(f.bits - 1) + 1;  // bits that are not ignored
  const double word =
      static_cast<double>((random() & 0xffffffffU) >> (32 - static_cast<unsigned>(bits)));
  if (!f.is_signed) return word;
  const double number = word - std::exp2(bits - 1);
  return f.sign_encoding == SignEncoding::sign_magnitude && number < 0.0 ? number + 1.0 : number;
}

/// Returns the row and column in the file of the scene pixel (row, column).
std::pair<int, int> row_and_column_in_file(const RawFormat& f, int row, int column) {
  // Undoes the quarter turns of the image one by one.
  int height = f.output_height(), width = f.output_width();
  for (int turned = 0; turned < f.rotate_deg; turned += 90) {
    std::tie(row, column) = std::pair(width - 1 - column, row);
    std::swap(height, width);
  }
  return {f.flip_rows ? height - 1 - row : row, f.flip_columns ? width - 1 - column : column};
}

/// Returns the position in the file of value j of the scene pixel (row, column).
std::size_t place_in_file(const RawFormat& f, int frame, int row, int column, int j) {
  const auto [r, c] = row_and_column_in_file(f, row, column);
  int place = 0;
  switch (f.layout) {
    case RawOrder::planar:
      place = ((frame * f.measurements + j) * f.height + r) * f.width + c;
      break;
    case RawOrder::interleaved:
      place = ((frame * f.height + r) * f.width + c) * f.measurements + j;
      break;
    case RawOrder::by_rows:
      place = ((frame * f.height + r) * f.measurements + j) * f.width + c;
      break;
  }
  return static_cast<std::size_t>(place);
}

std::vector<double> expected_pixel(const RawFormat& f, const std::vector<double>& numbers,
                                   int frame, int row, int column) {
  const auto [r, c] = row_and_column_in_file(f, row, column);
  const auto is_negated = [](NegatedLines lines, int line) {
    return lines == (line % 2 == 0 ? NegatedLines::even : NegatedLines::odd);
  };
  double sign = 1.0;
  for (const bool negated : {is_negated(f.negate_rows, r), is_negated(f.negate_columns, c),
                             f.negate_from_row > 0 && r >= f.negate_from_row,
                             f.negate_from_column > 0 && c >= f.negate_from_column})
    if (negated) sign = -sign;
  std::vector<double> pixel(static_cast<std::size_t>(f.kept_measurements()));
  for (int j = 0; j < f.measurements; ++j) {
    int measurement = j;
    if (!f.order.empty())
      measurement =
          j < static_cast<int>(f.order.size()) ? f.order[static_cast<std::size_t>(j)] : -1;
    if (measurement >= 0)
      pixel[static_cast<std::size_t>(measurement)] =
          sign * (numbers[place_in_file(f, frame, row, column, j)] - f.black_level);
  }
  if (!f.subtracts_taps()) return pixel;
  std::vector<double> differences;
  for (std::size_t k = 0; k < pixel.size(); k += 2) differences.push_back(pixel[k] - pixel[k + 1]);
  return differences;
}

TEST(RawFormat, UnpacksAnyDescription) {
  const TemporaryDirectory directory;
  const auto path = directory / "dump.bin";
  for (std::uint32_t item = 0; item < 400; ++item) {
    SCOPED_TRACE(item);
    RandomStream random(71, item);
    RawFormat f = random_format(random);
    const int frames = 1 + static_cast<int>(random() % 3);
    if (random() % 2 == 0) f.frames = frames;
    std::vector<double> numbers(
        static_cast<std::size_t>(frames * f.height * f.width * f.measurements));
    for (double& number : numbers) number = random_number(f, random);
    write_file_atomically(path, RawPacker(f).pack(numbers, frames), OutputPolicy::overwrite);
    RawReadOptions options;
    options.format = f;
    const RawFramesReader reader(path, options);
    ASSERT_EQ(reader.frames(), frames);
    ASSERT_EQ(reader.measurements(), f.output_measurements());
    EXPECT_EQ(reader.type(), f.needs_doubles() ? NpyType::float64 : NpyType::float32);
    ASSERT_EQ(reader.height(), f.rotate_deg % 180 == 0 ? f.height : f.width);
    const int height = reader.height();
    const int first = static_cast<int>(random() % static_cast<unsigned>(height));
    std::vector<std::byte> buffer;
    const RawView view = reader.read_rows(frames - 1, first, height - first, buffer);
    for (int row = first; row < height; ++row)
      for (int column = 0; column < reader.width(); ++column) {
        const auto pixel = expected_pixel(f, numbers, frames - 1, row, column);
        for (int k = 0; k < view.measurements; ++k) {
          const std::ptrdiff_t at = (row - first) * view.row_stride + column * view.column_stride +
                                    k * view.measurement_stride;
          const double expected = pixel[static_cast<std::size_t>(k)];
          if (f.needs_doubles())
            EXPECT_EQ(std::get<const double*>(view.data)[at], expected);
          else
            EXPECT_EQ(std::get<const float*>(view.data)[at], static_cast<float>(expected));
        }
      }
  }
}

// MIPI CSI-2: the first four bytes are bits 9 to 2, the fifth bits 1 to 0, first pixel lowest.
TEST(RawFormat, UnpacksMipiAccordingToTheStandard) {
  RawFormat f{.width = 4, .height = 1, .measurements = 1, .bits = 10};
  f.packing = RawPacking::mipi;
  const std::array bytes = {std::byte{0xff}, std::byte{0x00}, std::byte{0x80}, std::byte{0x01},
                            std::byte{0b11'00'10'01}};
  std::array<double, 4> numbers;
  unpack_numbers(f, bytes, 0, numbers);
  EXPECT_THAT(numbers, testing::ElementsAre(0x3fd, 0x002, 0x200, 0x007));
  f.bits = 12;
  f.width = 2;
  const std::array raw12 = {std::byte{0xab}, std::byte{0x12}, std::byte{0x3c}};
  std::array<double, 2> pair;
  unpack_numbers(f, raw12, 0, pair);
  EXPECT_THAT(pair, testing::ElementsAre(0xabc, 0x123));
}

/// The error of reading a dump; "" if there is none.
std::string error_of_dump(const RawFormat& format, const FileBytes& bytes) {
  const TemporaryDirectory directory;
  const auto path = directory / "dump.bin";
  write_file_atomically(path, bytes, OutputPolicy::overwrite);
  RawReadOptions options;
  options.format = format;
  try {
    read_frame(RawFramesReader(path, options), 0);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(RawFormat, RejectsNumbersThatDoNotFitIntoTheirBits) {
  RawFormat f{.width = 3, .height = 2, .measurements = 2, .bits = 12};
  const std::vector<double> numbers = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 300, 4095};
  const FileBytes low = RawPacker(f).pack(numbers, 1);
  EXPECT_EQ(error_of_dump(f, low), "");
  f.byte_order = RawByteOrder::big;
  EXPECT_THAT(error_of_dump(f, low),
              AllOf(HasSubstr("dump.bin: frame 0, image 1, row 1, number 1"),
                    HasSubstr("found 0x2c01 (11265), read as big-endian; expected 12 bits in the "
                              "low bits"),
                    HasSubstr("byte_order = \"little\" with align = \"low\" would fit")));
  f.unused_bits = UnusedBits::ignored;
  EXPECT_EQ(error_of_dump(f, low), "");
  f = {.width = 3, .height = 2, .measurements = 2, .bits = 12, .align = RawAlignment::high};
  const FileBytes high = RawPacker(f).pack(numbers, 1);
  EXPECT_EQ(error_of_dump(f, high), "");
  f.align = RawAlignment::low;
  EXPECT_THAT(error_of_dump(f, high), HasSubstr("with align = \"high\""));
}

TEST(RawFormat, AcceptsCopiesOfTheSignAboveSignedNumbers) {
  RawFormat f{.width = 2, .height = 1, .measurements = 1, .bits = 16, .is_signed = true};
  const FileBytes extended = RawPacker(f).pack({-5, 100}, 1);
  f.bits = 12;
  f.container_bits = 16;
  EXPECT_EQ(error_of_dump(f, extended), "");
  f.is_signed = false;
  EXPECT_THAT(error_of_dump(f, extended), HasSubstr("found 0xfffb"));
}

const char* const described = R"(# 11 bits in a stream, A and B of two subframes
width = 8
height = 2
measurements = 4
bits = 11
packing = "lsb_first"
signed = true
layout = "planar"
order = [2, 0, 3, 1]
flip_rows = true
taps = "subtract"
header_bytes = 16
)";

TEST(RawFormatToml, ReadsADescription) {
  const RawFormat f = parse_raw_format(described);
  EXPECT_EQ(f.width, 8);
  EXPECT_EQ(f.bits, 11);
  EXPECT_EQ(f.packing, RawPacking::lsb_first);
  EXPECT_EQ(f.order, (std::vector<int>{2, 0, 3, 1}));
  EXPECT_TRUE(f.is_signed && f.flip_rows && f.subtracts_taps());
  EXPECT_EQ(f.frame_bytes(), 4u * 2 * 11);
}

TEST(RawFormatToml, ReportsThePlaceAndTheProblem) {
  const std::string start = "width = 8\nheight = 2\nmeasurements = 4\nbits = 10\n";
  const auto error = [&](const std::string& line) {
    return io_error_of([&] { parse_raw_format(start + line, "s.raw.toml"); });
  };
  EXPECT_THAT(error("pakcing = \"mipi\""),
              AllOf(HasSubstr("s.raw.toml:5:1"), HasSubstr("did you mean packing?")));
  EXPECT_THAT(error("frame_footer_bytes = 8"),
              AllOf(HasSubstr("s.raw.toml:5:1: unknown key frame_footer_bytes"),
                    HasSubstr("frame_header_bytes, frame_trailer_bytes"), Not(HasSubstr("mean"))));
  EXPECT_THAT(error("packing = \"raw10\""), HasSubstr("mipi"));
  EXPECT_THAT(error("packing = \"mipi\"\nbyte_order = \"big\""),
              HasSubstr("must be omitted unless packing is plain"));
  EXPECT_THAT(error("packing = \"mipi\"\ncontainer_bits = 16"), HasSubstr("s.raw.toml:6:18"));
  EXPECT_THAT(error("container_bits = 8"), HasSubstr("8, 16 or 32 and hold bits = 10"));
  EXPECT_THAT(error("numbers = \"float\""), HasSubstr("bits = 10; must be 16, 32 or 64"));
  EXPECT_THAT(error("order = [0, 1, 2, 3, -1]"), HasSubstr("must list at most the 4 measurements"));
  EXPECT_THAT(error("order = [0, 1, 2, 2]"), HasSubstr("must list each of 0 to 3 once"));
  EXPECT_THAT(error("order = [1, 2, -1, 3]"), HasSubstr("must list each of 0 to 2 once"));
  EXPECT_THAT(error("order = [-1, -1, -1, -1]"), HasSubstr("must include a measurement"));
  EXPECT_THAT(error("order = [0, -2]"),
              AllOf(HasSubstr("s.raw.toml:5:9"), HasSubstr("order[1] = -2")));
  EXPECT_THAT(error("order = [0, 1, 2, 2.5]"), HasSubstr("an integer in ["));
  EXPECT_THAT(error("order = [0, 1, 2]\ntaps = \"subtract\""),
              AllOf(HasSubstr("order = 3"), HasSubstr("even to subtract taps")));
  EXPECT_THAT(error("sign_bit = 9"), HasSubstr("must be omitted unless signed = true"));
  EXPECT_THAT(error("sign_encoding = \"sign_magnitude\""), HasSubstr("unless signed = true"));
  EXPECT_THAT(error("signed = true\nsign_bit = 10"), HasSubstr("must be below bits = 10"));
  EXPECT_THAT(error("rotate_deg = 45"), HasSubstr("must be 0, 90, 180 or 270"));
  EXPECT_THAT(error("negate_rows = \"all\""), HasSubstr("\"none\", \"even\", \"odd\""));
  EXPECT_THAT(error("negate_from_row = 2"), HasSubstr("must be below height = 2"));
  EXPECT_THAT(error("frame_trailer_bytes = -1"), HasSubstr("frame_trailer_bytes = -1; must be"));
  EXPECT_THAT(error("layout = \"by_rows\"\nimage_trailer_bytes = 4"), HasSubstr("planar"));
  EXPECT_THAT(error("row_bytes = 15"), HasSubstr("at least 16 bytes"));
  EXPECT_THAT(error("row_header_bytes = 3\nrow_bytes = 18"), HasSubstr("at least 19 bytes"));
  EXPECT_THAT(error("rows_start_bytes = false"), HasSubstr("lsb_first or msb_first"));
  EXPECT_THAT(error("layout = \"interleaved\"\nimage_header_bytes = 4"), HasSubstr("planar"));
  EXPECT_THAT(error("taps = \"subtract\"\nblack_level = 3.0"), HasSubstr("which cancels it"));
  EXPECT_THAT(io_error_of([] { parse_raw_format("width = 8\n", "s.raw.toml"); }),
              HasSubstr("height"));
  EXPECT_THAT(io_error_of([] {
                parse_raw_format("width=7\nheight=1\nmeasurements=1\nbits=10\npacking=\"mipi\"");
              }),
              HasSubstr("complete groups of 4 numbers (it gives 7)"));
}

TEST(RawFormat, RejectsFilesWithPartialFrames) {
  const TemporaryDirectory directory;
  const auto path = directory / "dump.bin";
  RawReadOptions options;
  options.format = parse_raw_format(described);  // frames of 88 bytes after a header of 16
  const auto error = [&](std::size_t bytes, std::optional<int> measurements = {}) {
    options.measurements = measurements;
    write_file_atomically(path, FileBytes(bytes), OutputPolicy::overwrite);
    return io_error_of([&] { RawFramesReader reader(path, options); });
  };
  EXPECT_THAT(error(16 + 88 + 5),
              HasSubstr("found 109 bytes; expected 16 of header and a whole number of frames (1 or "
                        "more) of 2 x 8 pixels, 4 measurements of 11 bits, 88 bytes per frame; 5 "
                        "bytes are left over after 1 frames; from standard input, `decode - -o -` "
                        "decodes the 1 complete frame and reports the rest"));
  EXPECT_THAT(error(10), AllOf(HasSubstr("found 10 bytes"), Not(HasSubstr("standard input"))));
  EXPECT_THAT(error(16), HasSubstr("found 16 bytes"));
  EXPECT_THAT(error(16 + 88, 3), HasSubstr("gives 2 measurements per pixel; expected 3"));
  options.format->frames = 2;
  EXPECT_THAT(error(16 + 88), HasSubstr("found 104 bytes; expected 192"));
}

TEST(RawFrames, HalfPrecisionIsReadAsFloat) {
  const TemporaryDirectory directory;
  NpyArray halves(NpyType::float16, {1, 2, 3});
  const std::array<std::uint16_t, 6> bits = {0x3c00, 0xfbff, 0x0001, 0x8000, 0x7c00, 0x3555};
  std::memcpy(halves.bytes().data(), bits.data(), sizeof(bits));
  write_npy(directory / "a.npy", halves, OutputPolicy::overwrite);
  write_npz(directory / "a.npz", {{"raw", halves}}, OutputPolicy::overwrite);
  for (const char* name : {"a.npy", "a.npz"}) {
    const RawFramesReader reader(directory / name);
    EXPECT_EQ(reader.type(), NpyType::float32);
    EXPECT_FALSE(reader.holds_integers());
    EXPECT_THAT(read_frame(reader, 0).values,
                testing::ElementsAre(1.0f, -65504.0f, 0x1p-24f, -0.0f, INFINITY, 0x1.554p-2f));
  }
}

}  // namespace
}  // namespace tofsmith

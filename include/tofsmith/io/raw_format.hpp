// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Type of the numbers of a dump.
enum class RawNumbers { integers, floats };
constexpr auto words_of(RawNumbers /*any*/) { return word_list("integer", "float"); }

/// Packing of integers into bytes.
enum class RawPacking {
  plain,  ///< each in a container of 8, 16 or 32 bits
  mipi,   ///< CSI-2 RAW10, RAW12, RAW14: high bytes of a group, then the low bits of all of them
  lsb_first,  ///< a stream of bits, lowest bit of a byte first (RAW11, Mono10p, Mono12p)
  msb_first,  ///< a stream of bits, highest bit of a byte first
};
constexpr auto words_of(RawPacking /*any*/) {
  return word_list("plain", "mipi", "lsb_first", "msb_first");
}

/// Order of the numbers of a frame.
enum class RawOrder {
  planar,       ///< (F, K, H, W): one image per measurement
  interleaved,  ///< (F, H, W, K): measurements of a pixel are adjacent
  by_rows,      ///< (F, H, K, W): K consecutive rows, one per measurement
};
constexpr auto words_of(RawOrder /*any*/) { return word_list("planar", "interleaved", "by_rows"); }

/// Position of a number in a container that has more bits.
enum class RawAlignment { low, high };
constexpr auto words_of(RawAlignment /*any*/) { return word_list("low", "high"); }

/// Treatment of the unused bits of a container. checked: zero or copies of the sign.
enum class UnusedBits { checked, ignored };
constexpr auto words_of(UnusedBits /*any*/) { return word_list("checked", "ignored"); }

/// Encoding of negative integers.
enum class SignEncoding { twos_complement, sign_magnitude };
constexpr auto words_of(SignEncoding /*any*/) {
  return word_list("twos_complement", "sign_magnitude");
}

/// Rows or columns whose numbers are negated.
enum class NegatedLines { none, even, odd };
constexpr auto words_of(NegatedLines /*any*/) { return word_list("none", "even", "odd"); }

/// Significance of the first byte of a number, lowest (little) or highest (big).
enum class RawByteOrder { little, big };
constexpr auto words_of(RawByteOrder /*any*/) { return word_list("little", "big"); }

/// subtract: measurement 2 i minus measurement 2 i + 1.
enum class RawTaps { keep, subtract };
constexpr auto words_of(RawTaps /*any*/) { return word_list("keep", "subtract"); }

/// Layout of the raw data of a sensor, from a `*.raw.toml` file; see docs/raw_formats.md.
struct RawFormat {
  int width = 0;
  int height = 0;
  int measurements = 0;  ///< per pixel and frame, including skipped ones
  int frames = 0;        ///< 0: determined by the size of the file

  RawNumbers numbers = RawNumbers::integers;
  int bits = 16;           ///< integers 1 to 32, floats 16, 32 or 64
  int container_bits = 0;  ///< plain: 8, 16 or 32; 0: the smallest
  RawPacking packing = RawPacking::plain;
  RawAlignment align = RawAlignment::low;          ///< plain
  UnusedBits unused_bits = UnusedBits::checked;    ///< plain
  RawByteOrder byte_order = RawByteOrder::little;  ///< plain, and floats
  bool is_signed = false;
  SignEncoding sign_encoding = SignEncoding::twos_complement;  ///< signed
  std::optional<int> sign_bit;  ///< signed: bits above it are ignored
  NegatedLines negate_rows = NegatedLines::none;
  NegatedLines negate_columns = NegatedLines::none;
  int negate_from_row = 0;     ///< numbers from this row on are negated; 0: none
  int negate_from_column = 0;  ///< two negations cancel

  RawOrder layout = RawOrder::planar;
  /// Index of the measurement that is number j of a pixel; -1, or beyond the list: skipped. Empty:
  /// number j is measurement j.
  std::vector<int> order;
  bool flip_rows = false;
  bool flip_columns = false;
  int rotate_deg = 0;  ///< clockwise, after flips
  double black_level = 0.0;
  RawTaps taps = RawTaps::keep;

  // Skipped bytes.
  int header_bytes = 0;
  int trailer_bytes = 0;
  int frame_header_bytes = 0;
  int frame_trailer_bytes = 0;
  int image_header_bytes = 0;   ///< planar
  int image_trailer_bytes = 0;  ///< planar
  int row_header_bytes = 0;
  int row_bytes = 0;  ///< distance between rows; 0: no gap
  bool rows_start_bytes = true;

  /// Measurement stored as this number of a pixel; -1 if skipped.
  int measurement_of(int number) const;
  /// Number of measurements that are not skipped.
  int kept_measurements() const;
  bool subtracts_taps() const { return taps == RawTaps::subtract; }
  int output_measurements() const {
    return subtracts_taps() ? kept_measurements() / 2 : kept_measurements();
  }
  /// Returns true if the rotation exchanges rows and columns.
  bool is_transposed() const { return rotate_deg % 180 != 0; }
  /// Size after rotation.
  int output_height() const { return is_transposed() ? width : height; }
  int output_width() const { return is_transposed() ? height : width; }
  /// Returns true if decoded numbers exceed the precision of floats.
  bool needs_doubles() const { return bits > 24 && !(numbers == RawNumbers::floats && bits == 32); }
  int sign_bit_index() const { return sign_bit.value_or(bits - 1); }
  /// Bits that a number occupies in the file, including unused bits of its container.
  int stored_bits() const;

  std::size_t numbers_per_row() const;
  std::size_t rows_per_image() const;
  /// Images per frame: K if planar, else 1.
  std::size_t images() const;
  /// Numbers of a row, if rows start at whole bytes.
  std::uint64_t tight_row_bytes() const;
  /// Distance between rows, if rows start at whole bytes.
  std::uint64_t row_pitch_bytes() const;
  /// Size without header and trailer.
  std::uint64_t image_bytes() const;
  /// Size with headers and trailers.
  std::uint64_t frame_bytes() const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;

  friend bool operator==(const RawFormat&, const RawFormat&) = default;
};

/// Maximum size of a gap [bytes].
inline constexpr int max_raw_gap_bytes = (1 << 30) - 1;  // the sum of two gaps fits into an int

inline void describe(FieldVisitor& fields, RawFormat& f) {
  const Range gap = closed(0, max_raw_gap_bytes);
  fields.value(Key("width", "Columns of an image in the file", closed(1, 65536)).required("320"),
               f.width);
  fields.value(Key("height", "Rows of an image in the file", closed(1, 65536)).required("240"),
               f.height);
  fields.value(Key("measurements",
                   "Numbers per pixel and frame in the file (subframes x taps), including numbers "
                   "that `order` skips",
                   closed(1, 256))
                   .required("4"),
               f.measurements);
  fields.value(Key("frames", "Frames in the file; 0: determined by its size", at_least(0)),
               f.frames);
  fields.choice(Key("numbers", "Integers, or IEEE floats"), f.numbers);
  fields.value(
      Key("bits", "Bits of a number: integers 1 to 32, floats 16, 32 or 64").required("12"),
      f.bits);
  fields.value(Key("container_bits",
                   "Plain packing: size of the container of each number, 8, 16 or 32; 0: the "
                   "smallest for `bits`"),
               f.container_bits);
  fields.choice(Key("packing", "Packing of integers into bytes"), f.packing);
  fields.choice(Key("align",
                    "Plain packing: position of a number in its container, the low or the high "
                    "bits"),
                f.align);
  fields.choice(Key("unused_bits",
                    "Plain packing: unused bits of a container must be zero or copies of the sign "
                    "(checked), or may have any value (ignored)"),
                f.unused_bits);
  fields.choice(Key("byte_order",
                    "Plain packing and floats: significance of the first byte, lowest (little) or "
                    "highest (big)"),
                f.byte_order);
  fields.value(Key("signed", "Integers have a sign, e.g. differences A - B computed by the sensor"),
               f.is_signed);
  fields.choice(Key("sign_encoding", "Signed integers: encoding of negative numbers"),
                f.sign_encoding);
  fields.value(Key("sign_bit",
                   "Signed integers: index of the sign bit, from 0; bits above it are ignored; "
                   "default: the highest of `bits`",
                   closed(0, 31)),
               f.sign_bit);
  fields.choice(Key("negate_rows",
                    "Rows of each image in the file, counted from 0, whose numbers are negated"),
                f.negate_rows);
  fields.choice(Key("negate_columns",
                    "Columns of each image in the file, counted from 0, whose numbers are "
                    "negated"),
                f.negate_columns);
  fields.value(Key("negate_from_row",
                   "First row of each image in the file whose numbers are negated, as in all "
                   "later rows, in addition to the other keys (two negations cancel); 0: none",
                   closed(0, 65535)),
               f.negate_from_row);
  fields.value(Key("negate_from_column",
                   "First column of each image in the file whose numbers are negated, as in all "
                   "later columns, in addition to the other keys (two negations cancel); 0: none",
                   closed(0, 65535)),
               f.negate_from_column);
  fields.choice(Key("layout",
                    "One image per measurement (planar), adjacent measurements of each pixel "
                    "(interleaved), or consecutive rows, one per measurement (by_rows)"),
                f.layout);
  fields.value(Key("order",
                   "Index of the code's measurement, from 0, for each number of a pixel in the "
                   "file; -1: skipped, as are numbers beyond the list; default: 0, 1, 2, ...",
                   closed(-1, 255)),
               f.order);
  fields.choice(Key("taps",
                    "Keep the taps, or subtract them: measurements 0 and 1, 2 and 3, ... (after "
                    "`order`) become the difference A - B"),
                f.taps);
  fields.value(Key("flip_rows", "The file begins with the bottom row"), f.flip_rows);
  fields.value(Key("flip_columns", "Rows begin with the rightmost pixel"), f.flip_columns);
  fields.value(Key("rotate_deg",
                   "Clockwise rotation of each image in the file, after flips: 0, 90, 180 or 270"),
               f.rotate_deg);
  fields.value(Key("black_level", "Value to subtract from every number", finite()), f.black_level);
  fields.value(Key("header_bytes", "Bytes to skip before the first frame", gap), f.header_bytes);
  fields.value(Key("trailer_bytes", "Bytes to skip after the last frame", gap), f.trailer_bytes);
  fields.value(Key("frame_header_bytes", "Bytes to skip before every frame", gap),
               f.frame_header_bytes);
  fields.value(Key("frame_trailer_bytes", "Bytes to skip after every frame", gap),
               f.frame_trailer_bytes);
  fields.value(Key("image_header_bytes", "Bytes to skip before every image (planar)", gap),
               f.image_header_bytes);
  fields.value(Key("image_trailer_bytes", "Bytes to skip after every image (planar)", gap),
               f.image_trailer_bytes);
  fields.value(Key("row_header_bytes", "Bytes to skip before every row of the file", gap),
               f.row_header_bytes);
  fields.value(Key("row_bytes",
                   "Distance between the beginnings of consecutive rows in bytes, including "
                   "row_header_bytes; 0: no gap",
                   gap),
               f.row_bytes);
  fields.value(Key("rows_start_bytes", "Bit streams: each row starts at a whole byte"),
               f.rows_start_bytes);
}

/// Returns the keys in the format of camera_keys_json().
std::string raw_format_keys_json();

/// Parses a description. @param source_name  path, or name for error messages
/// @throws IoError "file:line:column: ..." for invalid TOML, keys or values
RawFormat parse_raw_format(std::string_view text, std::string_view source_name = "sensor.raw.toml");
RawFormat read_raw_format(const std::filesystem::path& path);

/// Returns the layout of the frames from the driver of a built-in camera, as TOML.
/// @throws std::invalid_argument for an unknown camera or layout
std::string built_in_raw_format_toml(const std::string& camera);
/// Returns the names of the built-in cameras with a known layout.
std::vector<std::string> built_in_raw_format_names();

/// Container whose number needs more than RawFormat::bits.
struct OversizedNumber {
  std::size_t index;  ///< in the row
  std::uint64_t container;
};
/// Returns the first oversized number of a row, a sign of a wrong byte order, alignment or number
/// of bits. None if unused bits are ignored.
std::optional<OversizedNumber> find_oversized_number(const RawFormat& format,
                                                     std::span<const std::byte> row);

/// Unpacks the numbers of a row, without black level, order and differences.
/// @param row        begins with the byte of the first bit
/// @param first_bit  position in this byte; 0 if rows start at whole bytes
void unpack_numbers(const RawFormat& format, std::span<const std::byte> row, int first_bit,
                    std::span<double> numbers);

}  // namespace tofsmith

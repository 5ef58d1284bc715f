// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
inline constexpr std::array<std::string_view, 2> raw_number_words{"integer", "float"};

/// How integers are stored in bytes.
enum class RawPacking {
  plain,  ///< each in a container of 8, 16 or 32 bits
  mipi,   ///< CSI-2 RAW10, RAW12, RAW14: high bytes of a group, then the low bits of all of them
  lsb_first,  ///< a stream of bits, lowest bit of a byte first (RAW11, Mono10p, Mono12p)
  msb_first,  ///< a stream of bits, highest bit of a byte first
};
inline constexpr std::array<std::string_view, 4> raw_packing_words{"plain", "mipi", "lsb_first",
                                                                   "msb_first"};

/// Order of the numbers of a frame.
enum class RawOrder {
  planar,       ///< (F, K, H, W): one image per number
  interleaved,  ///< (F, H, W, K): side by side
  by_rows,      ///< (F, H, K, W): one row of each in turn
};
inline constexpr std::array<std::string_view, 3> raw_order_words{"planar", "interleaved",
                                                                 "by_rows"};

/// Bits of a container that hold its number.
enum class RawAlignment { low, high };
inline constexpr std::array<std::string_view, 2> raw_alignment_words{"low", "high"};

/// Bits of a container beyond its number: zero or copies of the sign, or bits with other content.
enum class UnusedBits { checked, ignored };
inline constexpr std::array<std::string_view, 2> unused_bits_words{"checked", "ignored"};

/// How signed integers store negative numbers.
enum class SignEncoding { twos_complement, sign_magnitude };
inline constexpr std::array<std::string_view, 2> sign_encoding_words{"twos_complement",
                                                                     "sign_magnitude"};

/// Rows or columns of which the sign of every number is reversed.
enum class NegatedLines { none, even, odd };
inline constexpr std::array<std::string_view, 3> negated_lines_words{"none", "even", "odd"};

inline constexpr std::array<std::string_view, 2> raw_byte_order_words{"little", "big"};
inline constexpr std::array<std::string_view, 2> raw_tap_words{"keep", "subtract"};

/// The layout of a sensor's dump, which has no header that describes it: the content of a
/// `*.raw.toml` file. describe() lists its keys; docs/raw_formats.md explains them.
struct RawFormat {
  int width = 0;         ///< of an image of the file, pixels
  int height = 0;        ///< of an image of the file, pixels
  int measurements = 0;  ///< numbers per pixel and frame in the file, skipped ones included
  int frames = 0;        ///< 0: as many as the file holds

  RawNumbers numbers = RawNumbers::integers;
  int bits = 16;           ///< of a number: integers 1 to 32, floats 16, 32 or 64
  int container_bits = 0;  ///< plain: 8, 16 or 32; 0: as few as hold `bits`
  RawPacking packing = RawPacking::plain;
  RawAlignment align = RawAlignment::low;        ///< plain
  UnusedBits unused_bits = UnusedBits::checked;  ///< plain
  bool big_endian = false;                       ///< plain, and floats
  bool is_signed = false;
  SignEncoding sign_encoding = SignEncoding::twos_complement;  ///< signed
  std::optional<int> sign_bit;  ///< signed: bits above it are ignored; none: the highest
  NegatedLines negate_rows = NegatedLines::none;     ///< rows of the file, from 0
  NegatedLines negate_columns = NegatedLines::none;  ///< columns of the file, from 0
  int negate_from_row = 0;     ///< row of the file from which signs are reversed (again); 0: none
  int negate_from_column = 0;  ///< column of the file from which signs are reversed (again)

  RawOrder layout = RawOrder::planar;
  /// order[j]: the measurement that number j of a pixel in the file is; -1 and numbers after the
  /// end of the list are skipped. Empty: j.
  std::vector<int> order;
  bool flip_rows = false;      ///< the file begins with the lowest row
  bool flip_columns = false;   ///< rows begin at the right
  int rotate_deg = 0;          ///< clockwise, after flips: 0, 90, 180 or 270
  double black_level = 0.0;    ///< subtracted from every number
  bool subtract_taps = false;  ///< measurements 2 i and 2 i + 1 come out as their difference

  // Bytes that are skipped.
  int header_bytes = 0;          ///< before the first frame
  int trailer_bytes = 0;         ///< after the last frame
  int frame_header_bytes = 0;    ///< before every frame
  int frame_trailer_bytes = 0;   ///< after every frame
  int image_header_bytes = 0;    ///< before every image, planar
  int image_trailer_bytes = 0;   ///< after every image, planar
  int row_header_bytes = 0;      ///< before every row
  int row_bytes = 0;             ///< from one row to the next; 0: no gap
  bool rows_start_bytes = true;  ///< lsb_first, msb_first: each row at a whole byte

  /// Returns the measurement stored as the given number of a pixel in the file; -1 if skipped.
  int measurement_of(int number) const;
  /// Measurements that are not skipped.
  int kept_measurements() const;
  /// Numbers per pixel that are returned: the kept measurements, or half as many differences.
  int output_measurements() const {
    return subtract_taps ? kept_measurements() / 2 : kept_measurements();
  }
  /// Returns true if an image of the file is turned by a quarter.
  bool is_transposed() const { return rotate_deg % 180 != 0; }
  /// Rows of an image after its rotation.
  int output_height() const { return is_transposed() ? width : height; }
  /// Columns of an image after its rotation.
  int output_width() const { return is_transposed() ? height : width; }
  /// Returns true if decoded numbers need 64-bit floats to be exact.
  bool needs_doubles() const { return bits > 24 && !(numbers == RawNumbers::floats && bits == 32); }
  /// Index of the sign bit of signed integers.
  int sign_bit_index() const { return sign_bit.value_or(bits - 1); }

  /// Numbers in one row of the file.
  std::size_t numbers_per_row() const;
  /// Rows of one image, or of one frame where it has no images.
  std::size_t rows_per_image() const;
  /// Images of one frame: K if planar, else 1.
  std::size_t images() const;
  /// Size of the numbers of one row [bytes], where rows start at whole bytes.
  std::uint64_t tight_row_bytes() const;
  /// Distance of two rows [bytes], where rows start at whole bytes.
  std::uint64_t row_pitch_bytes() const;
  /// Size of one image without its header and trailer [bytes].
  std::uint64_t image_bytes() const;
  /// Size of one frame with its headers and trailers [bytes].
  std::uint64_t frame_bytes() const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;

  friend bool operator==(const RawFormat&, const RawFormat&) = default;
};

/// Most bytes of a gap.
inline constexpr int max_raw_gap_bytes = (1 << 30) - 1;  // two of them fit into an int

/// Keys of a .raw.toml file.
inline void describe(FieldVisitor& fields, RawFormat& f) {
  const Range gap = closed(0, max_raw_gap_bytes);
  fields.value(Key("width", "Pixels of a row of the file", closed(1, 65536)).required("320"),
               f.width);
  fields.value(Key("height", "Rows of an image of the file", closed(1, 65536)).required("240"),
               f.height);
  fields.value(Key("measurements",
                   "Numbers of a pixel in one frame of the file (subframes x taps), including "
                   "numbers that `order` skips",
                   closed(1, 256))
                   .required("4"),
               f.measurements);
  fields.value(Key("frames", "Frames of the file; 0: as many as fit", at_least(0)), f.frames);
  fields.choice(Key("numbers", "Integers, or IEEE floats"), f.numbers, raw_number_words);
  fields.value(
      Key("bits", "Bits of a number: integers 1 to 32, floats 16, 32 or 64").required("12"),
      f.bits);
  fields.value(Key("container_bits",
                   "Plain packing: 8, 16 or 32 bits that hold each number; 0: as few as hold "
                   "`bits`"),
               f.container_bits);
  fields.choice(Key("packing", "How integers are packed into bytes"), f.packing, raw_packing_words);
  fields.choice(Key("align",
                    "Plain packing: a number is in the low or the high bits of its "
                    "container"),
                f.align, raw_alignment_words);
  fields.choice(Key("unused_bits",
                    "Plain packing: bits of a container beyond `bits` must be zero or copies of "
                    "the sign, or are ignored because they hold something else"),
                f.unused_bits, unused_bits_words);
  fields.choice(Key("byte_order",
                    "Plain packing and floats: the first byte is the lowest or the "
                    "highest"),
                f.big_endian, raw_byte_order_words);
  fields.value(Key("signed", "Integers have a sign, such as a difference A - B made on the chip"),
               f.is_signed);
  fields.choice(Key("sign_encoding", "Signed integers: how negative numbers are stored"),
                f.sign_encoding, sign_encoding_words);
  fields.value(Key("sign_bit",
                   "Signed integers: bit with the sign, from 0; bits above it are ignored. Without "
                   "it, the highest of `bits`",
                   closed(0, 31)),
               f.sign_bit);
  fields.choice(Key("negate_rows",
                    "Rows of each image in the file, counted from 0, whose signs "
                    "are reversed"),
                f.negate_rows, negated_lines_words);
  fields.choice(Key("negate_columns",
                    "Columns of each image in the file, counted from 0, whose "
                    "signs are reversed"),
                f.negate_columns, negated_lines_words);
  fields.value(Key("negate_from_row",
                   "Row of each image in the file from which signs are reversed, in addition to "
                   "`negate_rows` and `negate_columns`; 0: none",
                   closed(0, 65535)),
               f.negate_from_row);
  fields.value(Key("negate_from_column",
                   "Column of each image in the file from which signs are reversed, in addition; "
                   "0: none",
                   closed(0, 65535)),
               f.negate_from_column);
  fields.choice(Key("layout",
                    "One image per number (planar), the numbers of a pixel side by side "
                    "(interleaved), or a row of each number in turn (by_rows)"),
                f.layout, raw_order_words);
  fields.value(Key("order",
                   "Measurement of the code, from 0, that each number of a pixel in the file is; "
                   "-1 skips a number, and so does a list that ends before it. Without it: 0, 1, "
                   "2, ...",
                   closed(-1, 255)),
               f.order);
  fields.choice(Key("taps",
                    "Keep the numbers, or return measurements 0 and 1, 2 and 3, ... (after "
                    "`order`) as the difference A - B"),
                f.subtract_taps, raw_tap_words);
  fields.value(Key("flip_rows", "The file begins with the lowest row"), f.flip_rows);
  fields.value(Key("flip_columns", "Rows begin at the right"), f.flip_columns);
  fields.value(Key("rotate_deg",
                   "Clockwise rotation of each image of the file, after flips: 0, 90, 180 or 270"),
               f.rotate_deg);
  fields.value(Key("black_level", "Subtracted from every number", finite()), f.black_level);
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
                   "Bytes from the beginning of one row of the file to the next, row_header_bytes "
                   "included; 0: no gap",
                   gap),
               f.row_bytes);
  fields.value(Key("rows_start_bytes", "Bit streams: each row begins with a whole byte"),
               f.rows_start_bytes);
}

/// Lists the keys of a description as a JSON array in the form of camera_keys_json().
std::string raw_format_keys_json();

/// Reads a description. @param source_name  path of the file, or what errors shall call it
/// @throws IoError "file:line:column: .." for text that is not TOML, unknown keys (with the nearest
///         known one), wrong types, and contradictory or broken rules
RawFormat parse_raw_format(std::string_view text, std::string_view source_name = "sensor.raw.toml");
/// @throws IoError as parse_raw_format(), or if the file cannot be read
RawFormat read_raw_format(const std::filesystem::path& path);

/// The raw frames of a built-in camera as its driver delivers them: a description to write to a
/// file, with its source as a comment.
/// @throws std::invalid_argument if there is no such camera, or its layout is not known, with the
/// reason
std::string built_in_raw_format_toml(const std::string& camera);
/// The cameras with such a description.
std::vector<std::string> built_in_raw_format_names();

/// A container of a plain dump with a number that exceeds its bits.
struct OversizedNumber {
  std::size_t index;        ///< of the number in the row
  std::uint64_t container;  ///< as stored
};
/// Returns the first number of a row that exceeds `bits`, which indicates a wrong byte order,
/// alignment or number of bits. None: all fit, or unused bits are ignored.
/// @param row  bytes from the first number on
std::optional<OversizedNumber> find_oversized_number(const RawFormat& format,
                                                     std::span<const std::byte> row);

/// Reads numbers of a row without black level, order and differences.
/// @param row        bytes from the first one that holds a bit of the row
/// @param first_bit  of the row in its first byte, 0 except for rows that do not start a byte
void unpack_numbers(const RawFormat& format, std::span<const std::byte> row, int first_bit,
                    std::span<double> numbers);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// What one number of a dump is.
enum class RawNumbers { integers, floats };

/// How integers lie in bytes.
enum class RawPacking {
  plain,  ///< each in a container of 8, 16 or 32 bits
  mipi,   ///< CSI-2 RAW10, RAW12, RAW14: high bytes of a group, then the low bits of all of them
  lsb_first,  ///< a stream of bits, lowest bit of a byte first (RAW11, Mono10p, Mono12p)
  msb_first,  ///< a stream of bits, highest bit of a byte first
};

/// Where the numbers of a pixel stand.
enum class RawOrder {
  planar,       ///< (F, K, H, W): one image per number
  interleaved,  ///< (F, H, W, K): side by side
  by_rows,      ///< (F, H, K, W): one row of each in turn
};

/// Whether a number's unused bits are the highest or the lowest of its container.
enum class RawAlignment { low, high };

/// A dump of a sensor, without header that says so: what a `*.raw.toml` file describes. Field names
/// are its keys; docs/raw_formats.md explains each.
struct RawFormat {
  int width = 0;                         ///< W, pixels
  int height = 0;                        ///< H, pixels
  int measurements = 0;                  ///< numbers per pixel as they stand in the file
  int frames = 0;                        ///< 0: as many as the file holds
  std::uint64_t header_bytes = 0;        ///< skipped at the beginning of the file
  std::uint64_t frame_header_bytes = 0;  ///< skipped ahead of every frame
  std::uint64_t image_header_bytes = 0;  ///< skipped ahead of every image, planar
  std::uint64_t row_bytes = 0;           ///< from one row to the next; 0: no gap

  RawNumbers numbers = RawNumbers::integers;
  int bits = 16;           ///< of a number: integers 1 .. 32, floats 32 or 64
  int container_bits = 0;  ///< plain: 8, 16 or 32; 0: as few as hold `bits`
  RawPacking packing = RawPacking::plain;
  RawAlignment align = RawAlignment::low;  ///< plain
  bool big_endian = false;                 ///< plain, and floats
  bool is_signed = false;                  ///< two's complement
  bool rows_start_bytes = true;            ///< lsb_first, msb_first: each row at a whole byte
  RawOrder layout = RawOrder::planar;
  std::vector<int> order;      ///< order[j]: which measurement number j of the file is; empty: j
  bool flip_rows = false;      ///< the file begins with the lowest row
  bool flip_columns = false;   ///< rows begin at the right
  double black_level = 0.0;    ///< taken off every number
  bool subtract_taps = false;  ///< measurements 2 i and 2 i + 1 come out as their difference

  /// Numbers per pixel that come out: K, or K / 2 differences.
  int output_measurements() const { return subtract_taps ? measurements / 2 : measurements; }
  /// Whether decoded numbers need 64-bit floats to be exact.
  bool needs_doubles() const { return bits > 24 && !(numbers == RawNumbers::floats && bits == 32); }

  /// Numbers in one row of the file.
  std::size_t numbers_per_row() const;
  /// Rows of one image, or of one frame where it has no images.
  std::size_t rows_per_image() const;
  /// Images of one frame: K if planar, else 1.
  std::size_t images() const;
  /// What one row takes without gap [bytes], where rows start at whole bytes.
  std::uint64_t tight_row_bytes() const;
  /// What one image takes without its header [bytes].
  std::uint64_t image_bytes() const;
  /// What one frame takes with its headers [bytes].
  std::uint64_t frame_bytes() const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;

  friend bool operator==(const RawFormat&, const RawFormat&) = default;
};

/// Reads a description. @param source_name  path of the file, or what errors shall call it
/// @throws IoError "file:line:column: .." for what is no TOML, unknown keys (with the nearest known
///         one), wrong types, and contradictory or broken rules
RawFormat parse_raw_format(std::string_view text, std::string_view source_name = "sensor.raw.toml");
/// @throws IoError as parse_raw_format(), or if the file cannot be read
RawFormat read_raw_format(const std::filesystem::path& path);

/// `count` numbers of a row, from number `first` on, as they stand in the file: black level, order
/// and differences come later.
/// @param row        bytes from the first one that holds a bit of the row
/// @param first_bit  of the row in its first byte, 0 but for rows that do not start a byte
void unpack_numbers(const RawFormat& format, std::span<const std::byte> row, int first_bit,
                    std::span<double> numbers);

}  // namespace tofsmith

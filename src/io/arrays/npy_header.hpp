// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// One line per NpyType, in its order.
struct NpyTypeEntry {
  NpyType type;
  std::string_view name;
  std::string_view code;  ///< NumPy's letter and size, without the byte order
  std::size_t bytes;      ///< per item
};
inline constexpr std::array<NpyTypeEntry, 12> npy_types = {{
    {NpyType::boolean, "bool", "b1", 1},
    {NpyType::int8, "int8", "i1", 1},
    {NpyType::int16, "int16", "i2", 2},
    {NpyType::int32, "int32", "i4", 4},
    {NpyType::int64, "int64", "i8", 8},
    {NpyType::uint8, "uint8", "u1", 1},
    {NpyType::uint16, "uint16", "u2", 2},
    {NpyType::uint32, "uint32", "u4", 4},
    {NpyType::uint64, "uint64", "u8", 8},
    {NpyType::float16, "float16", "f2", 2},
    {NpyType::float32, "float32", "f4", 4},
    {NpyType::float64, "float64", "f8", 8},
}};

/// What stands before the items of an NPY file.
struct NpyHeader {
  NpyType type = NpyType::float64;
  bool foreign_byte_order = false;
  bool fortran_order = false;
  NpyShape shape;
  std::size_t data_offset = 0;  ///< bytes from the start of the file
  std::size_t data_bytes = 0;
};

/// A header is never longer than this; it holds three short entries and padding [bytes].
inline constexpr std::size_t max_npy_header_bytes = 12 + 65536;

/// @param start  the file's first bytes, max_npy_header_bytes of them if it has that many
/// @param file_bytes  size of the whole file, against which the shape is checked
/// @throws IoError at a byte offset
NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                           std::string_view file);

/// Its length depends on the lengths of all axes but the first, so that a growing array can
/// write it again in place.
std::string serialize_npy_header(NpyType type, const NpyShape& shape);

/// Items of `array` stand as in the file: brings them to this machine's byte order, C order, and
/// bools to 0 and 1. The array's shape may be a slice of the file's.
void restore_host_order(const NpyHeader& header, NpyArray& array);

/// Items x bytes; nothing if that is more than memory has addresses.
std::optional<std::size_t> npy_byte_count(NpyType type, const NpyShape& shape);

}  // namespace tofsmith

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

/// In the order of NpyType.
struct NpyTypeEntry {
  NpyType type;
  std::string_view name;
  std::string_view code;  ///< NumPy's type code without the byte order
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

struct NpyHeader {
  NpyType type = NpyType::float64;
  bool foreign_byte_order = false;
  bool fortran_order = false;
  NpyShape shape;
  std::size_t data_offset = 0;  ///< from the start of the file
  std::size_t data_bytes = 0;
};

/// In bytes.
inline constexpr std::size_t max_npy_header_bytes = 12 + 65536;

/// @param start  first bytes of the file, up to max_npy_header_bytes
/// @throws IoError at a byte offset, also if the shape does not fit file_bytes
NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                           std::string_view file);

/// The length of the header does not depend on the first axis, so that a growing array can update
/// it in place.
std::string serialize_npy_header(NpyType type, const NpyShape& shape);

/// Converts items to native byte order and C order, and booleans to 0 and 1. The array may be a
/// slice of the file.
void restore_host_order(const NpyHeader& header, NpyArray& array);

/// Size of the items [bytes]; none if it exceeds the address space.
std::optional<std::size_t> npy_byte_count(NpyType type, const NpyShape& shape);

}  // namespace tofsmith

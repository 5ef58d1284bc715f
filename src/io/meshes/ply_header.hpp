// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/shared/byte_cursor.hpp"

namespace tofsmith {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t ply_item_size(PlyType type);
/// The number that stands at `item`, little end first.
double ply_number(const std::byte* item, PlyType type);
/// The type that a word such as "uchar" or "float32" names.
std::optional<PlyType> ply_type_of(std::string_view word);

/// Words of a line, parted by blanks.
std::vector<std::string_view> words_of_ply(std::string_view line);
/// Words of the next header line.
std::vector<std::string_view> words_of_ply_line(ByteCursor& cursor);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
};

/// What stands before the vertices of a PLY file.
struct PlyHeader {
  bool ascii = false;
  std::size_t vertices = 0;
  std::vector<PlyProperty> properties;

  std::size_t row_bytes() const;  ///< of one vertex in a binary file
};

/// Leaves the cursor at the first vertex. @throws IoError at a byte offset
PlyHeader parse_ply_header(ByteCursor& cursor);

}  // namespace tofsmith

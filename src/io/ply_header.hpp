// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/byte_cursor.hpp"

namespace tofsmith {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t ply_item_size(PlyType type);

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

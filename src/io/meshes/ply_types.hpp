// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"

namespace tofsmith {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t ply_item_size(PlyType type);
/// Reads little-endian order.
double ply_number(const std::byte* item, PlyType type);
/// Returns the type named "uchar", "float32" etc., if any.
std::optional<PlyType> ply_type_of(std::string_view word);

std::vector<std::string_view> words_of_ply(std::string_view line);
std::vector<std::string_view> words_of_ply_line(ByteCursor& cursor);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace tofsmith {

/// Prevents a damaged header from exhausting the memory.
inline constexpr std::uint64_t max_image_side = 65536;
inline constexpr std::uint64_t max_image_pixels = std::uint64_t{1} << 26;

/// @throws IoError naming `file` unless 1 <= height, width <= max_image_side and there are at most
///   max_image_pixels pixels
void check_image_size(std::string_view file, std::uint64_t height, std::uint64_t width);

}  // namespace tofsmith

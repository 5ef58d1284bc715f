// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Values as a PNG file holds them, (H, W, C), last axis fastest.
struct PngImage {
  int height = 0;
  int width = 0;
  int channels = 1;   ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
  int bit_depth = 8;  ///< 8 or 16
  std::vector<std::uint16_t> values;

  /// The value that stands for full white: 255 or 65535.
  int max_value() const { return bit_depth == 16 ? 65535 : 255; }
};

/// Palettes are looked up and values of fewer than 8 bits spread to 8; nothing else is changed.
/// @param file  what errors call it
/// @throws IoError if the file is damaged or larger than the limits of image_limits.hpp
PngImage parse_png(std::span<const std::byte> content, std::string_view file);
PngImage read_png(const std::filesystem::path& path);

/// @throws std::invalid_argument if a member is outside what its comment says, or a value above
///         max_value()
std::vector<std::byte> serialize_png(const PngImage& image);
/// @throws IoError as AtomicFile does
void write_png(const std::filesystem::path& path, const PngImage& image, OutputPolicy policy);

}  // namespace tofsmith

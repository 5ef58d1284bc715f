// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// (H, W, C), last axis fastest, top row first (files have the bottom row first).
struct PfmImage {
  int height = 0;
  int width = 0;
  int channels = 1;  ///< 1 grey, 3 RGB
  /// Absolute scale in the header; not applied, because programs disagree on its meaning.
  double scale = 1.0;
  std::vector<float> values;
};

/// @param file  name for error messages
/// @throws IoError if the header is malformed, the length of the data differs from it, or the image
///   exceeds the limits of image_limits.hpp
PfmImage parse_pfm(std::span<const std::byte> content, std::string_view file);
PfmImage read_pfm(const std::filesystem::path& path);

/// Little endian. @throws std::invalid_argument if a member is out of range
std::vector<std::byte> serialize_pfm(const PfmImage& image);
void write_pfm(const std::filesystem::path& path, const PfmImage& image, OutputPolicy policy);

}  // namespace tofsmith

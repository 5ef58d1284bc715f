// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Returns true if the extension is that of a grey image: .png, .tif, .tiff or .pgm.
bool is_grey_image(const std::filesystem::path& path);

/// Reads an image of one number per pixel, shape (H, W), in the file's own type: 8 or 16 bits, of a
/// TIFF also signed, 32 bits and floats.
/// @throws IoError if the file is damaged, has colours or several pages, or is packed in a way that
///         is not supported
NpyArray read_grey_image(const std::filesystem::path& path);

/// PGM, binary (P5) or text (P2): uint8 up to a largest number of 255, else uint16.
NpyArray parse_pgm(std::span<const std::byte> content, std::string_view file);

/// TIFF of one grey page in strips or tiles, not compressed or by PackBits, LZW or Deflate.
/// @see TIFF 6.0 specification
NpyArray parse_tiff(std::span<const std::byte> content, std::string_view file);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/images/exr.hpp"
#include "io/images/netpbm.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// @throws IoError unless the array contains floats of shape (H, W)
Image<float> image_from_array(const NpyArray& array, std::string_view file);

/// @throws IoError if the archive has several arrays and none with this name
std::string name_called_or_only(const NpzReader& archive, std::string_view name,
                                std::string_view file);
/// @throws IoError as name_called_or_only()
NpyArray array_called_or_only(const NpzReader& archive, std::string_view name,
                              std::string_view file);

/// @throws IoError unless the array contains floats
void require_floats(const NpyArray& array, std::string_view file);

/// @throws IoError if the image has colour channels
Image<float> image_from_pfm(PfmImage pfm, std::string_view file);

/// @throws std::invalid_argument if the image is empty
void require_pixels(const Image<float>& image);

/// Recognizes .png, .tif, .tiff and .pgm.
bool is_grey_image(const std::filesystem::path& path);

/// Reads one number per pixel, (H, W), in the type of the file: unsigned integers of 8 or 16 bits;
/// in TIFF also signed integers, 32 bits and floats.
/// @throws IoError if the file is damaged, has colours, several pages or an unsupported encoding
NpyArray read_grey_image(const std::filesystem::path& path);

/// Reads binary (P5) or text (P2); uint8 if the maximum value is at most 255, else uint16.
NpyArray parse_pgm(std::span<const std::byte> content, std::string_view file);

/// Reads a single page in strips or tiles, uncompressed or with PackBits, LZW or Deflate.
/// @see TIFF 6.0 specification
NpyArray parse_tiff(std::span<const std::byte> content, std::string_view file);

}  // namespace tofsmith

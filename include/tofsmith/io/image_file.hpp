// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Converts an sRGB value to linear light, both in [0, 1]. @see IEC 61966-2-1
double linear_from_srgb(double srgb);

/// Returns the luminance of linear light with Rec. 709 (sRGB) primaries.
constexpr double luminance_rec709(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/// Reads one number per pixel by extension:
///   .npy   float16, float32 or float64 of shape (H, W)
///   .npz   the same types, from the array `name` or the only array
///   .exr   the channel `name`, "Z" or "Y", the only channel, or R, G and B if all are equal
///   .pfm   grey
/// @throws IoError if the file is not such an image
Image<float> read_float_image(const std::filesystem::path& path, std::string_view name);
/// Reads an image named "kernel". @throws IoError also for an invalid kernel
Image<float> read_stray_light(const std::filesystem::path& path);

/// Writes float32, under the name `name` in .npz; in .exr "Z" for depth, else `name`.
/// @throws std::invalid_argument if the image is empty
void write_float_image(const std::filesystem::path& path, const Image<float>& image,
                       std::string_view name, OutputPolicy policy);

/// Values of a PNG file, (H, W, C), last axis fastest.
struct PngImage {
  int height = 0;
  int width = 0;
  int channels = 1;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
  int bit_depth = 8;
  std::vector<std::uint16_t> values;
  /// Text "Depth kind".
  std::string depth_kind = {};

  /// Returns the value of full white: 255 or 65535.
  int max_value() const { return bit_depth == 16 ? 65535 : 255; }
};

/// Decodes a PNG. Palettes are resolved and values of fewer than 8 bits scaled to 8 bits.
/// @throws IoError if the file is damaged, a side exceeds 65536 or the number of pixels 2^28
PngImage parse_png(std::span<const std::byte> content, std::string_view file);
PngImage read_png(const std::filesystem::path& path);

std::vector<std::byte> serialize_png(const PngImage& image);
void write_png(const std::filesystem::path& path, const PngImage& image, OutputPolicy policy);

enum class Transfer { srgb, linear };

/// Reads albedo, (H, W), as the Rec. 709 luminance of an image:
///   .png   8 or 16 bits, grey or RGB, alpha ignored; 1.0 is full white
///   .npy   floats, (H, W) or (H, W, 3), linear
///   .exr   "Y", the only channel, or R, G and B, linear
///   .pfm   grey or RGB, linear
/// @param png_transfer  usually sRGB for photographs and linear for measured albedo
Image<float> read_albedo(const std::filesystem::path& path, Transfer png_transfer = Transfer::srgb);

/// Converts an image to albedo in [0, 1]; an image with values above 1 is scaled down as a whole.
/// @param depth_m  same size or empty; where it is NaN, albedo may be NaN and becomes 0
/// @throws IoError naming the first pixel that is negative or not finite
Image<float> albedo_of_picture(Image<float> picture, std::string_view file,
                               const Image<float>& depth_m = {});

/// Reads the ambient light of every pixel, relative to the light of the scene.
/// @throws IoError as read_albedo(), or naming the first pixel that is negative or not finite
Image<float> read_ambient_scale(const std::filesystem::path& path,
                                Transfer png_transfer = Transfer::srgb);

}  // namespace tofsmith

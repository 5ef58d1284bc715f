// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Light of an sRGB value, both in [0, 1]. @see IEC 61966-2-1
double linear_from_srgb(double srgb);
/// Inverse of linear_from_srgb().
double srgb_from_linear(double linear);

/// Luminance of linear light with Rec. 709 (sRGB) primaries.
constexpr double luminance_rec709(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/// One number per pixel, as the file holds it, by the file's extension:
///   .npy   float16, float32 or float64 of shape (H, W)
///   .npz   the same, of the array `name`, or of the only one
///   .exr   the channel `name`, "Z" or "Y", or the only one, or R, G and B if all are equal
///   .pfm   grey
/// @param name  what the image shows, such as "depth" or "offset"
/// @throws IoError if the extension is another, or the file is not such an image
Image<float> read_float_image(const std::filesystem::path& path, std::string_view name);
/// Such an image called "kernel", of which a StrayLight can be made. @throws IoError also if not
Image<float> read_stray_light(const std::filesystem::path& path);

/// Writes float32; in .npz the array is called `name`, in .exr the channel is "Z" for depth and
/// `name` otherwise.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError if the extension is not one of the above, or as AtomicFile does
void write_float_image(const std::filesystem::path& path, const Image<float>& image,
                       std::string_view name, OutputPolicy policy);

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
/// @throws IoError if the file is damaged, a side above 65536 or the pixels above 2^28
PngImage parse_png(std::span<const std::byte> content, std::string_view file);
PngImage read_png(const std::filesystem::path& path);

/// @throws std::invalid_argument if a member is outside what its comment says, or a value above
///         max_value()
std::vector<std::byte> serialize_png(const PngImage& image);
/// @throws IoError as AtomicFile does
void write_png(const std::filesystem::path& path, const PngImage& image, OutputPolicy policy);

/// How the numbers of an image file relate to light.
enum class Transfer { srgb, linear };

/// Albedo, shape (H, W), as the Rec. 709 luminance of a picture:
///   .png   8 or 16 bits, grey or RGB, alpha ignored; 1.0 is full white
///   .npy   floats, (H, W) or (H, W, 3), linear
///   .exr   "Y", the only channel, or R, G and B, linear
///   .pfm   grey or RGB, linear
/// @param png_transfer  PNG files rarely say; photographs are sRGB, measured albedo may be linear
/// @throws IoError if the extension is another, or the file is not such an image
Image<float> read_albedo(const std::filesystem::path& path, Transfer png_transfer = Transfer::srgb);

/// Albedo in [0, 1] from what a picture holds. Radiance of a render can exceed 1; then the picture
/// is scaled down as a whole.
/// @param file  what errors call it
/// @param depth_m  empty, or of the picture's size: where nothing returns (NaN) albedo may be
///                 unknown (NaN) too, and becomes 0
/// @throws IoError naming the first pixel that is negative or not finite
Image<float> albedo_of_picture(Image<float> picture, std::string_view file,
                               const Image<float>& depth_m = {});

/// Ambient light of every pixel relative to the scene's, of the same files as read_albedo().
/// @throws IoError as read_albedo(), or naming the first pixel that is negative or not finite
Image<float> read_ambient_scale(const std::filesystem::path& path,
                                Transfer png_transfer = Transfer::srgb);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "tofsmith/core/array.hpp"

namespace tofsmith {

/// How the numbers of an image file relate to light.
enum class Transfer { srgb, linear };

/// Albedo, shape (H, W), as the Rec. 709 luminance of a picture:
///   .png   8 or 16 bits, grey or RGB, alpha ignored; 1.0 is full white
///   .npy   float32 or float64, (H, W) or (H, W, 3), linear
///   .exr   "Y", the only channel, or R, G and B, linear
///   .pfm   grey or RGB, linear
/// @param png_transfer  PNG files rarely say; photographs are sRGB, measured albedo may be linear
/// @throws IoError if the extension is another, or the file is not such an image
Image<float> read_albedo(const std::filesystem::path& path, Transfer png_transfer = Transfer::srgb);

/// Albedo in [0, 1] from what a picture holds. Radiance of a render can exceed 1; then the picture
/// is scaled down as a whole.
/// @param file  what errors call it
/// @param depth_m  where nothing returns (NaN) albedo may be unknown (NaN) too, and becomes 0;
/// empty
///                 or of the picture's size
/// @throws IoError naming the first pixel that is negative or not finite
Image<float> albedo_of_picture(Image<float> picture, std::string_view file,
                               const Image<float>& depth_m = {});

/// Ambient light of every pixel relative to the scene's, of the same files as read_albedo().
/// @throws IoError as read_albedo(), or naming the first pixel that is negative or not finite
Image<float> read_ambient_scale(const std::filesystem::path& path,
                                Transfer png_transfer = Transfer::srgb);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "tofsmith/core/array.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// One number per pixel, as the file holds it, by the file's extension:
///   .npy, .npz  float32 or float64 of shape (H, W); of an archive the array `name`, or the only
///   one .exr        the channel `name`, "Z" or "Y", or the only one, or R, G and B if all are
///   equal .pfm        grey
/// @param name  what the image shows, such as "depth" or "offset"
/// @throws IoError if the extension is another, or the file is not such an image
Image<float> read_float_image(const std::filesystem::path& path, std::string_view name);

/// Writes float32; in .npz the array is called `name`, in .exr the channel is "Z" for depth and
/// `name` otherwise.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError if the extension is not one of the above, or as AtomicFile does
void write_float_image(const std::filesystem::path& path, const Image<float>& image,
                       std::string_view name, OutputPolicy policy);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace tofsmith

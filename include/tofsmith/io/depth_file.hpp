// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tofsmith/core/array.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Depth [m], shape (H, W), NaN where nothing came back, from .npy, .npz, .exr, .pfm (metres, see
/// read_float_image()) or .png (16-bit grey, millimetres). In every format 0 means that nothing
/// came back, as depth cameras write it; so do NaN and infinity. Other values stay as they are.
/// @throws IoError if the extension is unknown or the file holds no depth image
Image<float> read_depth(const std::filesystem::path& path);

/// Writes depth [m] by extension. In .png it is rounded to millimetres and pixels that are not
/// finite become 0; the other formats hold the floats.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError if the extension is unknown, a depth does not fit into a .png (-0.0005 m to
///         65.535 m), or as AtomicFile does
void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/array.hpp"
#include "tofsmith/decode/pixel_status.hpp"

namespace tofsmith {

/// What a decoder says about every pixel of a frame; all planes are (H, W). Pixels without depth
/// (invalid, no_return) hold NaN in every plane but status.
struct DepthImage {
  Image<float> depth_m;          ///< distance along the ray [m], in [0, range)
  Image<float> signal_e_per_s;   ///< S [e/s]
  Image<float> ambient_e_per_s;  ///< A [e/s]; NaN where differences hide it; noise may make it < 0
  Image<float> confidence;       ///< that no far-off depth is the true one, in [0, 1]
  Image<float> predicted_standard_deviation_m;  ///< of depth around the right peak [m]
  Image<PixelStatus> status;

  DepthImage() = default;
  DepthImage(int height, int width);
  int height() const { return status.height; }
  int width() const { return status.width; }
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include <limits>

namespace tofsmith {

DepthImage::DepthImage(int height, int width)
    : depth_m(height, width, std::numeric_limits<float>::quiet_NaN()),
      signal_e_per_s(depth_m),
      ambient_e_per_s(depth_m),
      confidence(depth_m),
      predicted_standard_deviation_m(depth_m),
      status(height, width, PixelStatus::invalid) {}

}  // namespace tofsmith

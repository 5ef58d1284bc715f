// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

class RowCapture;

/// Light on the pixels of one frame before noise [e/s], and the depths it comes from.
struct CollectedLight {
  int height = 0, width = 0;
  int tap_values = 0;
  std::vector<double> taps;     ///< (H, W, tap values): S chi
  std::vector<double> ambient;  ///< (H, W); empty: the same everywhere
  Image<float> near_m, far_m;   ///< of what brings a pixel light; NaN: nothing does

  CollectedLight(int height_, int width_, int tap_values_);
};

/// Frames under one light, of which every pixel is to be given its noise.
struct UnexposedFrames {
  const RowCapture& source;
  const CollectedLight* light;  ///< null: the direct light of the source's scene, a ray a pixel
  int height, width;
  int first_frame, frames;
  float* raw;  ///< (frames, H, W, K), of the first frame on

  std::int64_t pixels() const { return std::int64_t{height} * width; }
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simulate/shared/row_capture.hpp"

namespace tofsmith {

/// Light on the pixels of one frame before noise [e/s], and the depths it comes from.
struct CollectedLight {
  int height = 0, width = 0;
  int tap_values = 0;
  std::vector<double> taps;     ///< (H, W, tap values): S chi
  std::vector<double> ambient;  ///< (H, W); empty: the same everywhere
  Image<float> near_m, far_m;   ///< of what brings a pixel light; NaN: nothing does

  CollectedLight(int height_, int width_, int tap_values_);
};

/// Tap values first .. first + count - 1, those of one exposure or of all.
struct TapRange {
  int first = 0, count = 0;
};

/// Adds what rays bring, blurred by the lens: every pixel's light is a weighted sum of that of rays
/// about it. Beyond the border the image goes on as its mirror image, so that no light is lost
/// and what is uniform stays so. Ambient light is added with tap value 0, depths with every one.
/// @param rays  `samples` x `samples` for each pixel
/// @throws std::invalid_argument if their image is not of that size, or as DiscKernels
/// @note the same bits for any number of threads
void add_light(const RowCapture& rays, const LensBlur& blur, int samples, TapRange range,
               CollectedLight& light);

/// Lets the lens scatter all light over the image: StrayLight::scatter() of each tap value and of
/// ambient light.
/// @param kernel             of StrayLight; empty: nothing changes
/// @param ambient_e_per_s  where `light` has none of its own
/// @throws std::invalid_argument as StrayLight
void scatter_light(const Image<float>& kernel, double ambient_e_per_s, CollectedLight& light);

/// Raw frames of that size, all 0.
RawFrames empty_frames(int frames, int height, int width, int measurements);

/// Frames under one light, each with noise of its own.
/// @throws Interrupted if progress says so
RawFrames captured_frames(const RowCapture& source, const CollectedLight& light, int frames,
                          const Progress& progress);

/// One frame of pixels under that light, (H, W, K).
void expose_pixels(const RowCapture& source, const CollectedLight& light, int frame, float* raw);

}  // namespace tofsmith

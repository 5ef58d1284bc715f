// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/row_capture.hpp"

namespace tofsmith {

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

}  // namespace tofsmith

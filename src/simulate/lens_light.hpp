// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/row_capture.hpp"

namespace tofsmith {

/// Tap values of one exposure or of all.
struct TapRange {
  int first = 0, count = 0;
};

/// Adds the light of rays, blurred by the lens. The image is continued by reflection, so that no
/// light is lost and uniform light remains uniform. Ambient light is added with tap value 0,
/// distances with every tap value. Deterministic.
/// @param rays  `samples` x `samples` per pixel
/// @throws std::invalid_argument if the size of their image does not match, or as DiscKernels
void add_light(const RowCapture& rays, const LensBlur& blur, int samples, TapRange range,
               CollectedLight& light);

/// Applies StrayLight::scatter() to each tap value and to ambient light.
/// @param kernel  of StrayLight; empty: no change
/// @param ambient_e_per_s  used if `light` has no ambient light
/// @throws std::invalid_argument as StrayLight
void scatter_light(const Image<float>& kernel, double ambient_e_per_s, CollectedLight& light);

RawFrames empty_frames(int frames, int height, int width, int measurements);

}  // namespace tofsmith

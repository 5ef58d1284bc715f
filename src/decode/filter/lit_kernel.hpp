// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

/// A bar of pixels at one side of a pixel, which is the middle of its first row.
struct LitBar {
  int length = 1;
  int depth = 1;                 ///< rows
  float max_added_sigma = 0.0f;  ///< only for pixels that were given no more light than this
  /// Its light is enough if it has this share of the light given, too, however dim.
  float enough_share = 1e30f;
};
/// Larger bars show less light. They are only for dim pixels, because they bridge narrow gaps.
inline constexpr std::array<LitBar, 4> lit_bars = {
    {{3, 2, 1e30f}, {5, 3, 3.0f}, {9, 5, 1.8f}, {13, 11, 0.9f, 0.75f}}};
inline constexpr int lit_directions = 8;
/// Amplitude from which a pixel's own measurements show its light [standard deviations].
inline constexpr float lit_pixel_sigma = 3.5f;
/// The same of bars.
inline constexpr float lit_bar_sigma = 4.0f;
/// Least share of the light that was given to a pixel that its bars must have, and likewise the
/// mean of the 3 x 3 pixels around it.
inline constexpr float lit_bar_share = 0.6f;
/// The 3 x 3 pixels are compared only where more light than this was given [standard deviations].
inline constexpr float lit_around_sigma = 1.4f;
/// A pixel of a bar counts as at most the light given plus this [standard deviations].
inline constexpr float lit_excess_sigma = 2.0f;

/// Pixels of all bars relative to their pixel: by bar, direction, row of the bar and place in it.
std::vector<WindowStep> lit_bar_points();
/// One over the standard deviation of the sum of the first rows of a bar of independent pixels.
float lit_bar_scale(const LitBar& bar, int rows);

/// Writes for a row how much light the measurements of each pixel show along the light that the
/// filter gave to it [standard deviations]; 0 for pixels that are not usable. Writes whole vectors.
void find_own_amplitude(const OwnLightTest& test, const FilterGrid& grid, int row,
                        float* amplitude);

/// The test whether pixels have light at all.
struct LitTest {
  const OwnLightTest* light = nullptr;
  const float* amplitude = nullptr;  ///< of find_own_amplitude(), with margins of 0
  const float* variance = nullptr;   ///< of a coordinate of the added light
  /// lit_bar_points() in the grid [floats].
  const std::ptrdiff_t* points = nullptr;
};
/// Writes for a row 1 where a pixel is lit or not usable, elsewhere v / (v + |u|^2), u the light
/// that was added and v its variance: that light may be all of neighbours, so that it is its own
/// error. A pixel is lit if its own measurements show it, or if all bars around it have light in
/// some of their first rows: beside the edge of an object, the bar that points away from it has
/// none.
void find_lit_share(const LitTest& test, const FilterGrid& grid, int row, float* share);

}  // namespace tofsmith

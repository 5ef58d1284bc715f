// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

/// A bar of pixels at one side of a pixel, which is the middle of the first row of the bar.
struct LitBar {
  int length = 1;
  int depth = 1;                 ///< rows
  float max_added_sigma = 0.0f;  ///< the bar applies to pixels with at most this added light
  /// This share of the added light is enough, even below lit_bar_sigma.
  float enough_share = 1e30f;
};
/// Larger bars detect dimmer light. They apply to dim pixels only, because they bridge narrow gaps.
inline constexpr std::array<LitBar, 4> lit_bars = {
    {{3, 2, 1e30f}, {5, 3, 3.0f}, {9, 5, 1.8f}, {13, 11, 0.9f, 0.75f}}};
inline constexpr int lit_directions = 8;
/// Largest distance between a pixel and the pixels of its bars, in rows or columns.
inline constexpr int lit_reach = [] {
  int reach = 0;
  for (const LitBar& bar : lit_bars)  // reach of straight and of diagonal bars
    reach = std::max({reach, bar.depth - 1, bar.length / 2 + bar.depth / 2});
  return reach;
}();
static_assert(lit_reach <= slope_reach, "bars must end within the margins of planes");
/// Smallest amplitude of a pixel's own measurements that proves its light [standard deviations].
inline constexpr float lit_pixel_sigma = 3.5f;
/// Smallest amplitude of a bar that proves light [standard deviations].
inline constexpr float lit_bar_sigma = 4.0f;
/// Minimum light of each bar, and of the mean of the 3 x 3 pixels around a pixel, relative to the
/// light added to the pixel.
inline constexpr float lit_bar_share = 0.6f;
/// The 3 x 3 pixels are only tested if the added light exceeds this [standard deviations].
inline constexpr float lit_around_sigma = 1.4f;
/// The amplitude of each pixel of a bar is limited to that of the added light plus this [standard
/// deviations].
inline constexpr float lit_excess_sigma = 2.0f;

/// Returns the pixels of all bars relative to their pixel, ordered by bar, direction, row of the
/// bar and place in the row.
std::vector<WindowStep> lit_bar_points();
/// Returns 1 / the standard deviation of the sum of the first rows of a bar of independent pixels.
float lit_bar_scale(const LitBar& bar, int rows);

/// Writes for each pixel of a row the amplitude of its measured light in the direction of the light
/// that was added to it [standard deviations]; 0 for unusable pixels. Writes whole vectors.
void find_own_amplitude(const OwnLightTest& test, const FilterGrid& grid, int row,
                        float* amplitude);

/// Inputs of find_lit_share().
struct LitTest {
  const OwnLightTest* light = nullptr;
  const float* amplitude = nullptr;  ///< from find_own_amplitude(), with margins of 0
  const float* variance = nullptr;   ///< of a coordinate of the added light
  /// lit_bar_points() as offsets in the grid [floats].
  const std::ptrdiff_t* points = nullptr;
};
/// Writes for each pixel of a row 1 if it is lit or not usable, else v / (v + |u|^2) with the added
/// light u and its variance v: all of u may be light of neighbours, in which case the error is u. A
/// pixel is lit if its own measurements prove it, or if the bars in all directions have light in
/// some of their first rows. Next to an object, the bar that points away from the object has no
/// light. Writes whole vectors.
void find_lit_share(const LitTest& test, const FilterGrid& grid, int row, float* share);

}  // namespace tofsmith

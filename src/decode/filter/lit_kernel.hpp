// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

/// A bar of pixels at one side of a pixel, which is the middle of its first row.
struct LitBar {
  int length = 1;
  int depth = 1;                 ///< rows
  float max_added_sigma = 0.0f;  ///< maximum added light of tested pixels
  float enough_share = 1e30f;
};
/// Larger bars detect dimmer light but bridge narrow gaps.
inline constexpr std::array<LitBar, 4> lit_bars = {
    {{3, 2, 1e30f}, {5, 3, 3.0f}, {9, 5, 1.8f}, {13, 11, 0.9f, 0.75f}}};
inline constexpr int lit_directions = 8;
inline constexpr int lit_reach = [] {
  int reach = 0;
  for (const LitBar& bar : lit_bars)
    reach = std::max({reach, bar.depth - 1, bar.length / 2 + bar.depth / 2});
  return reach;
}();
static_assert(lit_reach <= slope_reach, "bars must end within the margins of planes");
/// Amplitude of a pixel's own measurements that proves its light [standard deviations].
inline constexpr float lit_pixel_sigma = 3.5f;
/// Amplitude of a bar that proves light [standard deviations], after averaging over one window of
/// 5 x 5 pixels, and after further averaging, which adds light of pixels farther away.
inline constexpr float lit_bar_sigma_near = 3.0f, lit_bar_sigma_far = 4.0f;
/// Minimum light of each bar, and of the mean of 3 x 3 pixels, relative to the added light.
inline constexpr float lit_bar_share = 0.6f;
/// Added light from which the 3 x 3 pixels are tested [standard deviations].
inline constexpr float lit_around_sigma = 1.4f;
/// The amplitude of each pixel of a bar is limited to that of the added light plus this [standard
/// deviations].
inline constexpr float lit_excess_sigma = 2.0f;
/// The first bars, to which the following limit does not apply.
inline constexpr int lit_small_bars = 1;
/// Larger bars would bridge dark gaps between bright surfaces. They require that the mean of the
/// 3 x 3 pixels around a pixel is at least this share of the brightest such mean nearby, minus its
/// noise [standard deviations].
inline constexpr float lit_bright_share = 0.5f, lit_bright_sigma = 1.0f;
inline constexpr int lit_bright_reach = 2;

/// Returns the pixels of all bars, ordered by bar, direction, row and place in the row.
std::vector<WindowStep> lit_bar_points();
/// Returns 1 / the standard deviation of the sum of the first rows of a bar.
float lit_bar_scale(const LitBar& bar, int rows);

/// Rejected share of the nearest neighbours above which only a pixel's own measurements prove its
/// light: it can be on another surface than the pixels in opposite directions.
inline constexpr float lit_alone_share = 0.45f;

/// Writes the amplitude of the measured light of each pixel of a row in the direction d = u / |u|
/// of the added light [standard deviations]; 0 for unusable pixels. The pixel's own noise is part
/// of u and turns d towards it. The mean of this contribution is subtracted (Stein's lemma):
///   a = (y . d - v' div d) / sqrt(v),  div d = (r - 1) / |u|,
/// for measurements y of rank r and variance v, whose own share of u is at most v' / v.
/// Writes whole vectors.
/// @param variance  v' of the added light
void find_own_amplitude(const OwnLightTest& test, const float* variance, const FilterGrid& grid,
                        int row, float* amplitude);

struct LitTest {
  const OwnLightTest* light = nullptr;
  const float* amplitude = nullptr;  ///< from find_own_amplitude(), with margins of 0
  const float* variance = nullptr;   ///< of a coordinate of the added light
  const float* rejected = nullptr;   ///< share of the nearest neighbours; null: 0
  float bar_sigma = lit_bar_sigma_far;
  /// Offsets in the grid [floats].
  const std::ptrdiff_t* points = nullptr;
};
/// Writes for each pixel of a row 1 if it is lit or not usable, else v / (v + |u|^2) with the added
/// light u and its variance v: all of u may be light of neighbours. A pixel is lit if its own
/// measurements prove it, or if the bars in all directions have light: next to an object, the bar
/// that points away from it has none. In dark gaps (lit_bright_share) only the smallest bars count,
/// and above lit_alone_share of rejected neighbours none. Writes whole vectors.
void find_lit_share(const LitTest& test, const FilterGrid& grid, int row, float* share);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/shared/whole_vectors.hpp"
#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Planes of a frame, one float a pixel, with a margin all round where `usable` is 0. A plane's
/// pointer is that of its first pixel. What lies right of a row is the margin left of the next, and
/// what lies below a plane that above the next.
struct FilterGrid {
  int height = 0;
  int width = 0;
  std::ptrdiff_t stride = 0;  ///< from row to row [floats]
  int margin = 0;             ///< columns of the margin left of a row
  int rows_above = 0;         ///< of the margin

  std::ptrdiff_t plane_floats() const { return (height + rows_above) * stride; }
  /// Of a plane's first pixel, from where its margin begins.
  std::ptrdiff_t origin() const { return rows_above * stride + margin; }
  /// Of so many planes with all their margins.
  std::size_t floats(int planes) const {
    return static_cast<std::size_t>(planes * plane_floats() + rows_above * stride + margin);
  }
};
inline constexpr int slope_reach = 12;  ///< of the pixels that tell a slope
/// Rows that windows of a frame reach beyond it, and columns, with room for a whole vector.
constexpr int margin_rows(int largest_step) { return std::max(2 * largest_step + 2, slope_reach); }
constexpr int margin_columns(int largest_step) {
  return whole_vectors(margin_rows(largest_step)) + widest_vector;
}

/// Half of a window of 5 x 5 without its centre; the other half is opposite.
struct WindowStep {
  int rows = 0;
  int columns = 0;
};
inline constexpr std::array<WindowStep, 12> half_window = {{{0, 1},
                                                            {0, 2},
                                                            {1, -2},
                                                            {1, -1},
                                                            {1, 0},
                                                            {1, 1},
                                                            {1, 2},
                                                            {2, -2},
                                                            {2, -1},
                                                            {2, 0},
                                                            {2, 1},
                                                            {2, 2}}};
inline constexpr int window_reach = 2;
inline constexpr int patch_reach = 2;

/// Rows of a frame that are weighed and added together.
struct FilterStrip {
  int first_row = 0;
  int rows = 0;
  int step = 1;  ///< of the window [pixels]
  /// Rows above it whose pixels have weights, too.
  int rows_above() const { return window_reach * step; }
};

/// Weights of the pairs of a strip, w(pixel, pixel + step of half_window): [12][rows above and
/// rows][width], and what the neighbour's depth is beyond the slope, times its weight.
struct PairWeights {
  float* weight = nullptr;
  float* shifted = nullptr;  ///< null without slopes
  float* scratch = nullptr;  ///< rows of the test, see scratch_floats()
  std::ptrdiff_t stride = 0;
};
/// From row to row of weights, whose margins are their own [floats].
inline std::ptrdiff_t weight_stride(const FilterGrid& grid) {
  return whole_vectors(grid.width + 2 * grid.margin);
}
std::size_t weight_floats(const FilterGrid& grid, const FilterStrip& strip);
std::size_t scratch_floats(const FilterGrid& grid, const FilterStrip& strip);

/// Zeroes what a row of weights has beside its pixels. Vectors that reach beyond them write 0 there
/// again, because no pixel of a margin is usable.
inline void clear_margins(const FilterGrid& grid, float* row) {
  std::fill_n(row, grid.margin, 0.0f);
  const std::ptrdiff_t end = grid.margin + grid.width;
  std::fill_n(row + end, weight_stride(grid) - end, 0.0f);
}

/// Whether products are added in one step on this processor, rounded once.
bool fuses_products();

/// The test of parallelism.
struct SimilarityTest {
  std::array<const float*, max_measurements> u{};  ///< (rank) planes
  int rank = 0;
  const float* energy = nullptr;         ///< |u|^2 / v
  const float* inverse_sigma = nullptr;  ///< 1 / sqrt(v)
  const float* usable = nullptr;         ///< 1 or 0
  int patch_reach = 0;
  float max_difference_sigma = 0.0f;
};
void weigh_similar(const SimilarityTest& test, const FilterGrid& grid, const FilterStrip& strip,
                   const PairWeights& weights);

/// From the sum of lambda over a patch, but for the pair's own, to standard deviations.
struct PatchScale {
  PatchScale(int rank, int patch_reach);

  float by;           ///< deviations of a unit of the sum
  float expected;     ///< deviations of what noise alone makes
  float noise_limit;  ///< of a pair's own lambda: what noise can be
};

/// Of two opposite neighbours the brighter gives at most so many times the light of the other, if
/// light is balanced.
inline constexpr float balanced_light = 3.0f;
/// Of the depth that what is added is moved by along the slope, so much may be wrong.
inline constexpr float slope_error_share = 0.5f;
/// Only sums of so many standard deviations, squared, are balanced.
inline constexpr float balanced_energy = 25.0f;

/// Slopes err. Where as much light comes from either side of a pixel, that cancels; at silhouettes,
/// where pixels are ever darker, and beside edges it does not. There light is balanced, at the
/// price of noise: each pixel takes both sums by as much as leaves the least of error and noise.
struct LightBalance {
  const float* depth = nullptr;  ///< [bin], in [0, N)
  const float* slope_x = nullptr;
  const float* slope_y = nullptr;
  /// (N, 2): squares of how far light of signal 1 turns in a bin, and of its length.
  const float* squares = nullptr;
  int samples = 0;
  int step = 0;  ///< of the window [pixels]
};

/// What is added with the weights: planes in, their weighted means out.
struct WeightedSums {
  std::array<const float*, max_measurements + 1> in{};
  std::array<float*, max_measurements + 1> out{};
  int planes = 0;
  const float* variance = nullptr;
  float* variance_out = nullptr;
  const float* shifted_in = nullptr;  ///< the plane whose shifted mean is wanted; may be null
  float* shifted_out = nullptr;
  const LightBalance* balance = nullptr;  ///< of shifted_in; null where all is added
};
/// One row of a strip.
void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row);

/// The square of how far the middle of what was added of shifted_in lies from the pixel, in steps
/// of the window: 0 where as much comes from either side. Of the row that was added last.
void find_offsets(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row, float* offset2);

/// energy and inverse_sigma of a SimilarityTest: variances below `floor` count as that.
void find_energy(const std::array<const float*, max_measurements>& u, int rank,
                 const float* variance, const float* floor, float floor_share,
                 const FilterGrid& grid, int first_row, int rows, float* energy,
                 float* inverse_sigma);

/// Light of a single pixel from which the pixels around it are not tested [standard deviations].
inline constexpr float evident_sigma = 3.0f;
inline constexpr int own_light_reach = 3, own_light_side = 2 * own_light_reach + 1;
/// Least light of the pixels around a pixel, in standard deviations of its error and relative to
/// the added light.
inline constexpr float own_light_least_sigma = 1.0f, own_light_least_share = 0.05f;
/// Largest share of the pixels around that may be darker: fewer than half of them are on the far
/// side of a straight edge. This quantile of normal noise is own_light_below_mean standard
/// deviations below the mean, and its error is own_light_noise times that of the mean.
inline constexpr float own_light_share = 0.4f, own_light_below_mean = 0.25f;
inline constexpr float own_light_noise = 1.28f;

/// Test whether the light added to a pixel can be its own.
struct OwnLightTest {
  std::array<const float*, max_measurements> added{};     ///< (rank) planes
  std::array<const float*, max_measurements> measured{};  ///< (rank) planes of measured light
  int rank = 0;
  const float* usable = nullptr;    ///< 1 or 0
  const float* variance = nullptr;  ///< of a coordinate, as measured
  float limit_sigma = 0.0f;         ///< FilterOptions::own_light_sigma
};
/// Writes for a row 1 if the added light can be the pixel's own, 0 if not or if the pixel is not
/// usable. It cannot be if the pixels around have no light, or less than was added, so that dark
/// pixels next to an edge get no light from its other side. Writes whole vectors.
void find_own_light(const OwnLightTest& test, const FilterGrid& grid, int row, float* is_own);

}  // namespace tofsmith

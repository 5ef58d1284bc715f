// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

inline constexpr float min_depth_variance = 1e-8f;  // [bin^2], for noiseless scenes

/// Neighbours from which slopes are estimated, with the opposite ones. They are distant, because
/// close neighbours share noise after filtering.
inline constexpr std::array<WindowStep, 12> half_rings = {{{0, 3},
                                                           {3, -3},
                                                           {3, 0},
                                                           {3, 3},
                                                           {0, 6},
                                                           {6, -6},
                                                           {6, 0},
                                                           {6, 6},
                                                           {0, slope_reach},
                                                           {slope_reach, -slope_reach},
                                                           {slope_reach, 0},
                                                           {slope_reach, slope_reach}}};
/// Index of the first neighbour that shares few measurements with the pixel.
inline constexpr std::size_t first_far_ring = 8;

/// Inputs of the test of depths along slopes [bin].
struct SlopeTest {
  const float* depth = nullptr;
  const float* variance = nullptr;  ///< of depth
  const float* slope_x = nullptr;   ///< per column
  const float* slope_y = nullptr;   ///< per row
  const float* usable = nullptr;
  float samples = 0.0f;
  float same_depth_sigma2 = 0.0f;
  float max_difference_sigma = 0.0f;
};
void weigh_along_slopes(const SlopeTest& test, const FilterGrid& grid, const FilterStrip& strip,
                        const PairWeights& weights);

/// Computes the slopes of a plane through the depths of pixels 3 to 12 away on the same surface; 0
/// if there are too few pixels.
/// @param excess  factor >= 1 by which the scatter of far pixels exceeds the variance of their
///     depths
void find_slopes(const SlopeTest& test, const FilterGrid& grid, int row, float* slope_x,
                 float* slope_y, float* excess);

/// x = T o chi. The first `rank` coordinates span the decoding subspace.
struct CurvePoints {
  const float* points = nullptr;  ///< (samples, coordinates)
  int samples = 0;
  int coordinates = 0;
  int rank = 0;
};

/// Splits light into signal along the depth and a remainder, which contains all light of pixels
/// without a depth.
struct SplitRow {
  const float* depth = nullptr;   ///< [bin], in [0, N)
  const float* guided = nullptr;  ///< > 0 if the pixel has a depth
  std::array<const float*, max_measurements> in{};
  std::array<float*, max_measurements> out{};
  float* signal = nullptr;
};
void split_row(const CurvePoints& curve, const SplitRow& row, int width);

/// Adds the signal to the remainder, at the depth shifted by shift / signal.
struct JoinRow {
  const float* depth = nullptr;
  const float* guided = nullptr;
  const float* signal = nullptr;
  const float* shift = nullptr;  ///< [signal bin]; null: no shift
  std::array<float*, max_measurements> light{};
};
void join_row(const CurvePoints& curve, const JoinRow& row, int width);

/// Compared pixels: every second one of 13 x 13, because adjacent near sums share most
/// measurements.
inline constexpr int compared_reach = 6, compared_step = 2;
/// Pixels of a line in each of four directions: 9, every third one.
inline constexpr int line_side = 4, line_step = 3, line_reach = line_side * line_step;
inline constexpr std::array<WindowStep, 4> line_directions = {{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
/// Lower limit of the difference's variance, relative to that of the near sum.
inline constexpr float least_noise_share = 0.25f;
/// Thresholds that noise explains: mean squared difference of the pixels around [standard
/// deviations], and squared mean along the best line and around, divided by the number of pixels.
inline constexpr float explained_by_noise = 2.3f, explained_along_lines = 18.0f;
inline constexpr float explained_in_patch = 12.0f;
/// An excess e above the threshold keeps the share e / (e + this) of the near sum.
inline constexpr float half_kept = 0.2f, half_kept_along_lines = 0.3f;
/// Factor of the near sum's variance if noise alone causes it to be kept.
inline constexpr float kept_noise = 1.6f;
/// Minimum squared signal-to-noise ratio of near sums with a useful depth.
inline constexpr float least_energy = 25.0f;
/// Signal-to-noise ratio from which near sums alone determine slopes.
inline constexpr float bright_sigma = 50.0f;

/// Sums over near neighbours only, and over near and far neighbours.
struct NearAndFar {
  std::array<const float*, max_measurements> near{};
  std::array<float*, max_measurements> far{};  ///< input; then the mixture of both sums
  int planes = 0, rank = 0;
  const float* usable = nullptr;  ///< 1 or 0
  const float* depth = nullptr;   ///< of the far sum [bin], in [0, N)
  const float* near_variance = nullptr;
  float* far_variance = nullptr;  ///< input; then the variance of the mixture
  float* difference = nullptr;    ///< between the depths of both sums [standard deviations]
  float* kept = nullptr;          ///< output: share of the near sum
};
void compare_sums(const CurvePoints& curve, const NearAndFar& sums, const FilterGrid& grid,
                  int row);
/// Mixes the near sum back in where far neighbours belong to another or a curved surface: where the
/// depths of both sums differ by more than noise, around a pixel or along a line through it. Its
/// share minimizes bias and noise. Requires `difference` of the surrounding rows.
void keep_near(const NearAndFar& sums, const FilterGrid& grid, int row);
/// Mixes the near sum back in for bright pixels, before slopes are known: none below bright_sigma,
/// all from twice that ratio on. Far neighbours would bias the depth and thus the slopes.
void keep_bright(const NearAndFar& sums, const FilterGrid& grid, int row);

/// Bias of a pass along slopes where other surfaces are near. The squared bias, relative to the
/// variance v of the result, increases to `near` while the rejected share of the nearest neighbours
/// increases from `from` to `full`. Beyond that it increases by (v0 / v - 1) per rejected share,
/// with the variance v0 of the pixel's own measurements (benchmarks/scene_deviations.py).
struct EdgeBias {
  float from = 0.2f, full = 0.45f, near = 6.0f;
};
inline constexpr EdgeBias edge_bias;
/// Returns the factor of the deviation of the result.
/// @param rejected  share of the nearest neighbours
/// @param averaged  v0 / v
float deviation_factor(float rejected, float averaged);

/// Variance added to a sum along slopes by the noise of the slopes:
///   v (sum + sum_offset d^2) + v' (before + before_offset d^2)
/// with the variance v of the sum without it, the variance v' of the depth that determined the
/// slopes, and the distance d of the averaged pixels' centroid in steps of the last window. The
/// constant is the measured reduction for near sums inside a plane.
inline constexpr float slope_noise_of_near = 0.67f;
struct SlopeNoise {
  float sum, sum_offset, before, before_offset;
};
SlopeNoise slope_noise_of(int windows, int round);

}  // namespace tofsmith

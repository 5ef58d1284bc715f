// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

inline constexpr float min_depth_variance = 1e-8f;  // [bin^2], of scenes without noise

/// Neighbours that tell the slope, and those opposite: few, because near ones of filtered pixels
/// share their noise.
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
/// From this one of them on pixels are so far apart that they share few measurements.
inline constexpr std::size_t first_far_ring = 8;

/// The test of depths along slopes, all in bins.
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

/// Slopes of the plane through the depths of pixels 3 to 12 away that are of the same surface; 0
/// where there are too few.
/// @param excess  of depth's variance, >= 1: how much more the depths of far pixels of the surface
///                scatter about the plane
void find_slopes(const SlopeTest& test, const FilterGrid& grid, int first_row, int rows,
                 float* slope_x, float* slope_y, float* excess);

/// x = T o chi in coordinates of which the first `rank` are those of the decoding plane.
struct CurvePoints {
  const float* points = nullptr;  ///< (samples, coordinates)
  int samples = 0;
  int coordinates = 0;
  int rank = 0;
};

/// A row's light into signal along its depth and the rest; without a depth all is rest.
struct SplitRow {
  const float* depth = nullptr;   ///< [bin], in [0, N)
  const float* guided = nullptr;  ///< > 0 where there is a depth
  std::array<const float*, max_measurements> in{};
  std::array<float*, max_measurements> out{};
  float* signal = nullptr;
};
void split_row(const CurvePoints& curve, const SplitRow& row, int width);

/// Adds a row's signal to the rest of its light, where its depth is and shift / signal beyond.
struct JoinRow {
  const float* depth = nullptr;
  const float* guided = nullptr;
  const float* signal = nullptr;
  const float* shift = nullptr;  ///< [signal bin]; null where nothing is moved
  std::array<float*, max_measurements> light{};
};
void join_row(const CurvePoints& curve, const JoinRow& row, int width);

/// Pixels around one that are looked at together: 7 x 7, every other one, because near sums of
/// pixels side by side share most of their measurements.
inline constexpr int compared_reach = 6, compared_step = 2;
/// And 9 in a row, every third one, through the pixel in each of four directions.
inline constexpr int line_side = 4, line_step = 3, line_reach = line_side * line_step;
inline constexpr std::array<WindowStep, 4> line_directions = {{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
/// Of the near sum's variance, so much is the least that its difference from the far one has.
inline constexpr float least_noise_share = 0.25f;
/// Mean square of differences in deviations that noise is taken to make, of the pixels around; and
/// square of their mean along the best of the lines and around, divided by how many count.
inline constexpr float explained_by_noise = 2.3f, explained_along_lines = 18.0f;
inline constexpr float explained_in_patch = 12.0f;
/// What exceeds it is kept as excess / (excess + this).
inline constexpr float half_kept = 0.2f, half_kept_along_lines = 0.3f;
/// How much larger than usual the noise of a near sum is where noise alone has some of it kept.
inline constexpr float kept_noise = 1.6f;
/// Near sums of fewer standard deviations, squared, tell too little of their depth.
inline constexpr float least_energy = 25.0f;
/// From so many standard deviations on near sums alone tell slopes, and little bends.
inline constexpr float bright_sigma = 50.0f;

/// Two sums for each pixel: of near neighbours, and of these and far ones.
struct NearAndFar {
  std::array<const float*, max_measurements> near{};
  std::array<float*, max_measurements> far{};  ///< and then what is kept of both
  int planes = 0, rank = 0;
  const float* usable = nullptr;  ///< 1 or 0
  const float* depth = nullptr;   ///< of both [bin], in [0, N)
  const float* near_variance = nullptr;
  float* far_variance = nullptr;  ///< and then that of what is kept
  float* difference = nullptr;    ///< of the two depths [standard deviations]
  float* kept = nullptr;          ///< and the share of the near sum that is kept
};
/// `difference` of a row.
void compare_sums(const CurvePoints& curve, const NearAndFar& sums, const FilterGrid& grid,
                  int row);
/// Far neighbours may be of another surface, or of one that bends, by less than the test of a pair
/// sees. Where the sums with them, of pixels around one or along a line through it, have other
/// depths than the near sums by more than noise explains, so much of the near sum is kept that the
/// bias and the noise that it leaves are least. Needs `difference` of the rows around.
void keep_near(const NearAndFar& sums, const FilterGrid& grid, int row);
/// Before there are slopes: from bright_sigma on the less noise a near sum has, the more of it is
/// kept, and all from twice that on. Its depth tells slopes well enough, and far neighbours, which
/// lie along slopes that are not known yet, would bias it.
void keep_bright(const NearAndFar& sums, const FilterGrid& grid, int row);

/// What the noise of slopes adds to the variance of a sum along them,
///   v (sum + sum_offset d^2) + v' (before + before_offset d^2),
/// where v is the variance of the sum without it, v' that of the depth that slopes were taken from,
/// and d how far the middle of what was added lies from the pixel, in steps of the last window.
/// Inside a plane depths of near sums alone count less by this share, measured.
inline constexpr float slope_noise_of_near = 0.67f;
struct SlopeNoise {
  float sum, sum_offset, before, before_offset;
};
/// For so many windows, in this round of those.
SlopeNoise slope_noise_of(int windows, int round);

}  // namespace tofsmith

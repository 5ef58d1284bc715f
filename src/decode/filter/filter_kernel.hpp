// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/shared/whole_vectors.hpp"
#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Layout of the planes of a frame, one float per pixel, with margins in which `usable` is 0. The
/// margin right of a row is the left margin of the next row; the margin below a plane is the upper
/// margin of the next plane. Pointers to planes point to the first pixel.
struct FilterGrid {
  int height = 0;
  int width = 0;
  std::ptrdiff_t stride = 0;  ///< between rows [floats]
  int margin = 0;
  int rows_above = 0;

  std::ptrdiff_t plane_floats() const { return (height + rows_above) * stride; }
  std::ptrdiff_t origin() const { return rows_above * stride + margin; }
  std::size_t floats(int planes) const {
    return static_cast<std::size_t>(planes * plane_floats() + rows_above * stride + margin);
  }
};
/// Reach of the pixels that determine a slope, in rows or columns.
inline constexpr int slope_reach = 12;
/// Rows and columns by which windows extend beyond a frame. Columns include a vector.
constexpr int margin_rows(int largest_step) { return std::max(2 * largest_step + 2, slope_reach); }
constexpr int margin_columns(int largest_step) {
  return whole_vectors(margin_rows(largest_step)) + widest_vector;
}

/// Offset within one half of a window of 5 x 5 pixels without its centre.
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

/// Rows that are processed together.
struct FilterStrip {
  int first_row = 0;
  int rows = 0;
  int step = 1;  ///< of the window [pixels]
  int rows_above() const { return window_reach * step; }
};

/// Weights w(pixel, pixel + step of half_window) of a strip, (12, rows above and rows, width), and
/// products of weight and depth difference beyond the slope.
struct PairWeights {
  float* weight = nullptr;
  float* shifted = nullptr;  ///< null without slopes
  float* scratch = nullptr;  ///< rows of the test, see scratch_floats()
  std::ptrdiff_t stride = 0;
};
inline std::ptrdiff_t weight_stride(const FilterGrid& grid) {
  return whole_vectors(grid.width + 2 * grid.margin);
}
std::size_t weight_floats(const FilterGrid& grid, const FilterStrip& strip);
std::size_t scratch_floats(const FilterGrid& grid, const FilterStrip& strip);

/// Vectors that extend into the margins write 0 there as well, because no pixel of a margin is
/// usable.
inline void clear_margins(const FilterGrid& grid, float* row) {
  std::fill_n(row, grid.margin, 0.0f);
  const std::ptrdiff_t end = grid.margin + grid.width;
  std::fill_n(row + end, weight_stride(grid) - end, 0.0f);
}

/// Returns true if this processor has fused multiply-add (FMA).
bool fuses_products();

struct SimilarityTest {
  std::array<const float*, max_measurements> u{};  ///< (rank) planes
  int rank = 0;
  const float* energy = nullptr;         ///< |u|^2 / v
  const float* inverse_sigma = nullptr;  ///< 1 / sqrt(v)
  const float* usable = nullptr;
  int patch_reach = 0;
  float max_difference_sigma = 0.0f;
};
void weigh_similar(const SimilarityTest& test, const FilterGrid& grid, const FilterStrip& strip,
                   const PairWeights& weights);

/// Converts the sum of lambda over a patch to standard deviations.
struct PatchScale {
  PatchScale(int rank, int patch_reach);

  float by;           ///< standard deviations per unit of the sum
  float expected;     ///< mean of the sum from noise alone [standard deviations]
  float noise_limit;  ///< upper limit of a pair's lambda from noise
};

/// Maximum ratio of the light of a neighbour to that of the opposite one.
inline constexpr float balanced_light = 3.0f;
/// Relative error of a shift along the slope.
inline constexpr float slope_error_share = 0.5f;
/// Minimum squared signal-to-noise ratio for balancing.
inline constexpr float balanced_energy = 25.0f;

/// Balances light from opposite sides of a pixel, so that errors of slopes cancel at edges and
/// silhouettes, where pixels become darker in one direction. Balancing increases the noise, so each
/// pixel uses the mixture of both sums that minimizes error plus noise.
struct LightBalance {
  const float* depth = nullptr;  ///< [bin], in [0, N)
  const float* slope_x = nullptr;
  const float* slope_y = nullptr;
  /// (N, 2): squared change per bin of the direction of light with signal 1, and its squared
  /// length.
  const float* squares = nullptr;
  int samples = 0;
  int step = 0;  ///< of the window [pixels]
};

/// Bound on the bias of a window of similar pixels, some of which have another depth. The squared
/// bias is at most share (rejected - by_noise) (v - v'), with the rejected share of the neighbours
/// and the variances v before and v' after the window (benchmarks/scene_deviations.py).
struct BiasBound {
  float share = 0.0f;
  float by_noise = 0.0f;  ///< share of the neighbours that noise rejects on flat surfaces
};
inline constexpr BiasBound similar_bias{0.1f, 0.4f};

struct WeightedSums {
  std::array<const float*, max_measurements + 1> in{};
  std::array<float*, max_measurements + 1> out{};
  int planes = 0;
  const float* variance = nullptr;
  float* variance_out = nullptr;
  BiasBound bias;                     ///< added to variance_out
  float* rejected = nullptr;          ///< share of the neighbours without weight; may be null
  const float* shifted_in = nullptr;  ///< may be null
  float* shifted_out = nullptr;
  const LightBalance* balance = nullptr;  ///< for shifted_in; null: no balancing
};
void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row);

/// Computes the squared distance of the centroid of the light in shifted_in from the pixel [window
/// steps^2], for the row of the last call of add_weighted().
void find_offsets(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row, float* offset2);

/// Computes energy and inverse_sigma of a SimilarityTest; `floor` limits the variances.
void find_energy(const SimilarityTest& test, const float* variance, const float* floor,
                 float floor_share, const FilterGrid& grid, int row, float* energy,
                 float* inverse_sigma);

/// Pixels with more light are not tested [standard deviations].
inline constexpr float evident_sigma = 3.0f;
inline constexpr int own_light_reach = 3, own_light_side = 2 * own_light_reach + 1;
/// Minimum light around a pixel, in standard deviations of its error and relative to the averaged
/// light.
inline constexpr float own_light_least_sigma = 1.0f, own_light_least_share = 0.05f;
/// Maximum fraction of darker pixels around a pixel: fewer than half are beyond a straight edge.
/// For normal noise this quantile is own_light_below_mean standard deviations below the mean, and
/// its error is own_light_noise times that of the mean.
inline constexpr float own_light_share = 0.4f, own_light_below_mean = 0.25f;
inline constexpr float own_light_noise = 1.28f;

struct OwnLightTest {
  std::array<const float*, max_measurements> added{};  ///< (rank) planes
  std::array<const float*, max_measurements> measured{};
  int rank = 0;
  const float* usable = nullptr;    ///< 1 or 0
  const float* variance = nullptr;  ///< of a coordinate of the measurements
  float limit_sigma = 0.0f;         ///< FilterOptions::own_light_sigma
};
/// Writes 1 for each pixel of a row whose averaged light can come from the pixel itself, else 0: it
/// cannot if the surrounding pixels have no light, or less than the average. Dark pixels next to an
/// edge thus receive no light from its other side. Writes whole vectors.
void find_own_light(const OwnLightTest& test, const FilterGrid& grid, int row, float* is_own);

inline constexpr int patch_side = 2 * patch_reach + 1;
inline constexpr int patch_pixels = patch_side * patch_side;

/// Returns the chi^2 quantile with the tail probability of `sigma` standard deviations
/// (Wilson-Hilferty approximation).
inline float chi2_limit(int freedom, double sigma) {
  const double spread = 2.0 / (9.0 * freedom);
  return static_cast<float>(freedom * std::pow(1.0 - spread + sigma * std::sqrt(spread), 3));
}

/// Chi^2 test for changes: no change below `certain`, full change from `most` on.
struct ChangeTest {
  /// Fraction of max_sigma below which the past keeps its full weight.
  static constexpr double certain_share = 0.6;

  ChangeTest(int freedom, double max_sigma)
      : certain(chi2_limit(freedom, certain_share * max_sigma)),
        most(chi2_limit(freedom, max_sigma)) {}

  /// Fraction of the past that is kept.
  float share(float chi2) const { return std::clamp((most - chi2) / (most - certain), 0.0f, 1.0f); }
  float beyond(float chi2) const { return std::max(0.0f, chi2 - certain); }

  float certain, most;
};

/// Adds values to sums (time_kernel.cpp).
void add_to_sums(const float* values, std::ptrdiff_t count, float* sums);

/// Rows of a strip and of the patches around it. Planes: chi^2, usable flag, and K differences in
/// standard deviations.
class ComparedRows {
 public:
  ComparedRows(int rows, int width, int measurements, std::vector<float>& room)
      : rows_(rows), planes_(planes_of(measurements)), pitch_(width + 2 * patch_reach) {
    const std::size_t wanted = floats(rows, width, measurements);
    if (room.size() < wanted) room.resize(wanted);
    first_ = room.data();
  }
  static std::size_t floats(int rows, int width, int measurements) {
    return static_cast<std::size_t>(rows + 1) * static_cast<std::size_t>(planes_of(measurements)) *
           static_cast<std::size_t>(width + 2 * patch_reach);
  }

  /// First pixel of a row.
  float* chi2(int row) { return plane(row, 0) + patch_reach; }
  float* counts(int row) { return plane(row, 1) + patch_reach; }
  /// Distance between measurements [floats].
  std::ptrdiff_t pitch() const { return pitch_; }
  float* difference(int row, int k) { return plane(row, 2 + k) + patch_reach; }

  void clear(int row, float chi2) {
    std::fill_n(plane(row, 0), pitch_, chi2);
    std::fill_n(plane(row, 1), (planes_ - 1) * pitch_, 0.0f);
  }
  /// Adds the rows of a patch; returns the index of the sums.
  int add_rows(int first_row) {
    float* const sums = plane(rows_, 0);
    std::copy_n(plane(first_row, 0), planes_ * pitch_, sums);
    for (int row = first_row + 1; row < first_row + patch_side; ++row)
      add_to_sums(plane(row, 0), planes_ * pitch_, sums);
    return rows_;
  }

 private:
  static int planes_of(int measurements) { return measurements + 2; }
  float* plane(int row, int index) {
    return first_ + (std::ptrdiff_t{row} * planes_ + index) * pitch_;
  }

  int rows_, planes_;
  std::ptrdiff_t pitch_;
  float* first_;
};

}  // namespace tofsmith

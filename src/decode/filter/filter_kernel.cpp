// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/filter_kernel.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/filter/filter_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own header after foreach_target.
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Vector load(const float* from) { return hn::LoadU(Floats(), from); }
HWY_INLINE void store(Vector value, float* to) { hn::StoreU(value, Floats(), to); }

/// 1 without a difference, 0 from the largest on, smooth between.
HWY_INLINE Vector weight_of(Vector difference, Vector inverse_max) {
  const Vector zero = hn::Zero(Floats());
  const Vector left =
      hn::Max(hn::NegMulAdd(hn::Max(difference, zero), inverse_max, all(1.0f)), zero);
  const Vector square = hn::Mul(left, left);
  return hn::Mul(square, square);
}

/// lambda of the pixels of a row and of those `away` from them, from column -reach on; rank - 1
/// where one of both is not usable.
HWY_INLINE void test_row(const SimilarityTest& test, std::ptrdiff_t at, std::ptrdiff_t away,
                         int columns, float* lambda) {
  const Vector half = all(0.5f), four = all(4.0f),
               expected = all(static_cast<float>(test.rank - 1));
  const Vector zero = hn::Zero(Floats());
  for (int x = 0; x < columns; x += lanes_of()) {
    const std::ptrdiff_t p = at + x, q = p + away;
    Vector dot = zero;
    for (int j = 0; j < test.rank; ++j) {
      const float* const u = test.u.data()[j];
      dot = hn::MulAdd(load(u + p), load(u + q), dot);
    }
    const Vector c = hn::Max(
        hn::Mul(dot, hn::Mul(load(test.inverse_sigma + p), load(test.inverse_sigma + q))), zero);
    const Vector a = load(test.energy + p), b = load(test.energy + q);
    const Vector apart = hn::Sub(a, b), sum = hn::Add(a, b);
    const Vector root = hn::Sqrt(hn::MulAdd(apart, apart, hn::Mul(four, hn::Mul(c, c))));
    // (sum - root) / 2 of large numbers that are nearly equal would be rounding.
    const Vector product = hn::NegMulAdd(c, c, hn::Mul(a, b));
    const Vector least = hn::Div(hn::Add(hn::Max(product, zero), hn::Max(product, zero)),
                                 hn::Max(hn::Add(sum, root), all(1e-30f)));
    const Mask both = hn::Gt(hn::Mul(load(test.usable + p), load(test.usable + q)), half);
    store(hn::IfThenElse(both, least, expected), lambda + x);
  }
}

void weigh_similar(const SimilarityTest& test, const FilterGrid& grid, const FilterStrip& strip,
                   const PairWeights& weights) {
  const int reach = test.patch_reach, side = 2 * reach + 1;
  const auto patch = static_cast<float>(side * side), freedom = static_cast<float>(test.rank - 1);
  const float deviations = std::sqrt(patch / (2 * freedom));
  const Vector by = all(deviations / patch), expected = all(freedom * deviations);
  const Vector inverse_max = all(1.0f / test.max_difference_sigma);
  const int rows = strip.rows + strip.rows_above();
  float* const lambda = weights.scratch;
  float* const sums = weights.scratch + weights.stride;
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    const int down = half_window[i].rows * strip.step, right = half_window[i].columns * strip.step;
    const std::ptrdiff_t away = down * grid.stride + right;
    const int top = strip.first_row - down;  // the first row whose weights are used
    const int test_rows = strip.rows + down + 2 * reach;
    for (int r = 0; r < test_rows; ++r) {
      test_row(test, (top - reach + r) * grid.stride - reach, away, grid.width + 2 * reach, lambda);
      float* const sum = sums + r * weights.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        Vector s = load(lambda + x);
        for (int n = 1; n < side; ++n) s = hn::Add(s, load(lambda + x + n));
        store(s, sum + x);
      }
    }
    for (int r = 0; r < strip.rows + down; ++r) {
      float* const row =
          weights.weight +
          (static_cast<std::ptrdiff_t>(i) * rows + r + strip.rows_above() - down) * weights.stride;
      std::fill_n(row, weights.stride, 0.0f);
      const std::ptrdiff_t at = (top + r) * grid.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        Vector s = load(sums + r * weights.stride + x);
        for (int n = 1; n < side; ++n) s = hn::Add(s, load(sums + (r + n) * weights.stride + x));
        const Vector w = weight_of(hn::MulSub(s, by, expected), inverse_max);
        const Vector both = hn::Mul(load(test.usable + at + x), load(test.usable + at + x + away));
        store(hn::Mul(w, both), row + grid.margin + x);
      }
    }
  }
}

/// A difference of depths, of a period's bins, as the nearest way round.
HWY_INLINE Vector nearest(Vector difference, Vector samples, Vector per_sample) {
  return hn::NegMulAdd(hn::Round(hn::Mul(difference, per_sample)), samples, difference);
}

constexpr float min_depth_variance = 1e-8f;  // [bin^2], of scenes without noise

void weigh_along_slopes(const SlopeTest& test, const FilterGrid& grid, const FilterStrip& strip,
                        const PairWeights& weights) {
  const Vector samples = all(test.samples), per_sample = all(1.0f / test.samples);
  const Vector inverse_max = all(1.0f / test.max_difference_sigma);
  const int rows = strip.rows + strip.rows_above();
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    const int down = half_window[i].rows * strip.step, right = half_window[i].columns * strip.step;
    const std::ptrdiff_t away = down * grid.stride + right;
    const Vector half_down = all(0.5f * static_cast<float>(down));
    const Vector half_right = all(0.5f * static_cast<float>(right));
    for (int r = strip.rows_above() - down; r < rows; ++r) {
      const std::ptrdiff_t row = (static_cast<std::ptrdiff_t>(i) * rows + r) * weights.stride;
      std::fill_n(weights.weight + row, weights.stride, 0.0f);
      std::fill_n(weights.shifted + row, weights.stride, 0.0f);
      const std::ptrdiff_t first = (strip.first_row - strip.rows_above() + r) * grid.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        const std::ptrdiff_t p = first + x, q = p + away;
        const Vector across = hn::Add(load(test.slope_x + p), load(test.slope_x + q));
        const Vector along = hn::Add(load(test.slope_y + p), load(test.slope_y + q));
        const Vector expected = hn::MulAdd(across, half_right, hn::Mul(along, half_down));
        const Vector difference =
            hn::Sub(hn::Sub(load(test.depth + q), load(test.depth + p)), expected);
        const Vector beyond = nearest(difference, samples, per_sample);
        const Vector variance = hn::Max(hn::Add(load(test.variance + p), load(test.variance + q)),
                                        all(min_depth_variance));
        const Vector squares =
            hn::Div(hn::Mul(beyond, beyond), hn::Mul(all(test.same_depth_sigma2), variance));
        const Vector both = hn::Mul(load(test.usable + p), load(test.usable + q));
        const Vector w = hn::Mul(weight_of(hn::Sub(squares, all(1.0f)), inverse_max), both);
        store(w, weights.weight + row + grid.margin + x);
        store(hn::Mul(w, beyond), weights.shifted + row + grid.margin + x);
      }
    }
  }
}

/// Sums of a plane's slopes, weighted: of x^2, x y, y^2, x d, y d.
struct SlopeSums {
  Vector xx, xy, yy, xd, yd;
  HWY_INLINE SlopeSums() : xx(hn::Zero(Floats())), xy(xx), yy(xx), xd(xx), yd(xx) {}
  HWY_INLINE void add(Vector weight, float x, float y, Vector difference) {
    const Vector d = hn::Mul(weight, difference);
    xx = hn::MulAdd(weight, all(x * x), xx);
    xy = hn::MulAdd(weight, all(x * y), xy);
    yy = hn::MulAdd(weight, all(y * y), yy);
    xd = hn::MulAdd(d, all(x), xd);
    yd = hn::MulAdd(d, all(y), yd);
  }
  /// One direction alone tells nothing of the other.
  HWY_INLINE void solve(Vector& slope_x, Vector& slope_y) const {
    const Vector little = hn::MulAdd(hn::Add(xx, yy), all(1e-4f), all(1e-20f));
    const Vector a = hn::Add(xx, little), b = hn::Add(yy, little);
    const Vector inverse = hn::Div(all(1.0f), hn::NegMulAdd(xy, xy, hn::Mul(a, b)));
    slope_x = hn::Mul(hn::NegMulAdd(xy, yd, hn::Mul(b, xd)), inverse);
    slope_y = hn::Mul(hn::NegMulAdd(xy, xd, hn::Mul(a, yd)), inverse);
  }
};

/// Neighbours that tell the slope: few, because near ones of filtered pixels share their noise.
constexpr WindowStep half_rings[] = {{0, 2}, {2, -2}, {2, 0}, {2, 2},
                                     {0, 4}, {4, -4}, {4, 0}, {4, 4}};

void find_slopes(const SlopeTest& test, const FilterGrid& grid, int first_row, int rows,
                 float* slope_x, float* slope_y) {
  const Vector samples = all(test.samples), per_sample = all(1.0f / test.samples);
  const Vector tiny = all(min_depth_variance), zero = hn::Zero(Floats());
  const Vector inverse_max = all(1.0f / (4 * test.same_depth_sigma2));
  for (int y = first_row; y < first_row + rows; ++y)
    for (int x = 0; x < grid.width; x += lanes_of()) {
      const std::ptrdiff_t p = y * grid.stride + x;
      const Vector depth = load(test.depth + p), variance = load(test.variance + p);
      const auto neighbour = [&](std::ptrdiff_t away, Vector& difference, Vector& noise) {
        difference = nearest(hn::Sub(load(test.depth + p + away), depth), samples, per_sample);
        noise = hn::Max(load(test.variance + p + away), tiny);
        return load(test.usable + p + away);
      };
      // Opposite neighbours that differ from the pixel by as much in opposite ways, ..
      SlopeSums pairs;
      for (const WindowStep& s : half_rings) {
        const std::ptrdiff_t away = s.rows * grid.stride + s.columns;
        Vector ahead, behind, noise_ahead, noise_behind;
        const Vector both =
            hn::Mul(neighbour(away, ahead, noise_ahead), neighbour(-away, behind, noise_behind));
        const Vector bend = hn::Add(ahead, behind), noise = hn::Add(noise_ahead, noise_behind);
        const Vector all_noise = hn::MulAdd(variance, all(4.0f), noise);
        const Vector w = hn::Div(
            hn::Mul(weight_of(hn::Div(hn::Mul(bend, bend), all_noise), inverse_max), both), noise);
        pairs.add(w, static_cast<float>(s.columns), static_cast<float>(s.rows),
                  hn::Mul(hn::Sub(ahead, behind), all(0.5f)));
      }
      Vector across, along;
      pairs.solve(across, along);
      // .. then every neighbour that the plane so found explains.
      SlopeSums singles;
      for (const WindowStep& s : half_rings)
        for (const int sign : {1, -1}) {
          const int right = sign * s.columns, down = sign * s.rows;
          Vector difference, noise;
          const Vector usable = neighbour(down * grid.stride + right, difference, noise);
          const Vector expected = hn::MulAdd(across, all(static_cast<float>(right)),
                                             hn::Mul(along, all(static_cast<float>(down))));
          const Vector beyond = hn::Sub(difference, expected);
          const Vector squares = hn::Div(hn::Mul(beyond, beyond), hn::Add(noise, variance));
          const Vector w = hn::Div(hn::Mul(weight_of(squares, inverse_max), usable), noise);
          singles.add(w, static_cast<float>(right), static_cast<float>(down), difference);
        }
      singles.solve(across, along);
      const Mask usable = hn::Gt(load(test.usable + p), zero);
      store(hn::IfThenElseZero(usable, across), slope_x + p);
      store(hn::IfThenElseZero(usable, along), slope_y + p);
    }
}

/// Where a row's pairs and their weights are.
struct RowPairs {
  std::array<const float*, half_window.size()> ahead, behind;  // weights
  std::array<std::ptrdiff_t, half_window.size()> away;         // of the neighbour ahead
};

RowPairs pairs_of_row(const FilterGrid& grid, const FilterStrip& strip, const float* weights,
                      std::ptrdiff_t stride, int row) {
  RowPairs pairs;
  const int rows = strip.rows + strip.rows_above();
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    const int down = half_window[i].rows * strip.step, right = half_window[i].columns * strip.step;
    const float* const own =
        weights + (static_cast<std::ptrdiff_t>(i) * rows + row + strip.rows_above()) * stride +
        grid.margin;
    pairs.ahead[i] = own;
    pairs.behind[i] = own - down * stride - right;
    pairs.away[i] = down * grid.stride + right;
  }
  return pairs;
}

/// Weighted means of `Count` planes, once their inverse sums of weights are known.
template <int Count>
HWY_INLINE void add_planes(const WeightedSums& sums, int first, const RowPairs& pairs, int width,
                           std::ptrdiff_t row, const float* inverse_sum) {
  for (int x = 0; x < width; x += lanes_of()) {
    Vector sum[Count];
    for (int k = 0; k < Count; ++k) sum[k] = load(sums.in.data()[first + k] + row + x);
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const Vector ahead = load(pairs.ahead.data()[i] + x),
                   behind = load(pairs.behind.data()[i] + x);
      const std::ptrdiff_t away = pairs.away.data()[i];
      for (int k = 0; k < Count; ++k) {
        const float* const at = sums.in.data()[first + k] + row + x;
        sum[k] = hn::MulAdd(ahead, load(at + away), sum[k]);
        sum[k] = hn::MulAdd(behind, load(at - away), sum[k]);
      }
    }
    const Vector by = load(inverse_sum + x);
    for (int k = 0; k < Count; ++k)
      store(hn::Mul(sum[k], by), sums.out.data()[first + k] + row + x);
  }
}

/// Sums of weights, and the variance of what they add up.
HWY_INLINE void add_variances(const WeightedSums& sums, const RowPairs& pairs, int width,
                              std::ptrdiff_t row, float* inverse_sum) {
  for (int x = 0; x < width; x += lanes_of()) {
    const float* const at = sums.variance + row + x;
    Vector sum = all(1.0f), variance = load(at);
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const Vector ahead = load(pairs.ahead.data()[i] + x),
                   behind = load(pairs.behind.data()[i] + x);
      const std::ptrdiff_t away = pairs.away.data()[i];
      sum = hn::Add(sum, hn::Add(ahead, behind));
      variance = hn::MulAdd(hn::Mul(ahead, ahead), load(at + away), variance);
      variance = hn::MulAdd(hn::Mul(behind, behind), load(at - away), variance);
    }
    const Vector inverse = hn::Div(all(1.0f), sum);
    store(inverse, inverse_sum + x);
    store(hn::Mul(variance, hn::Mul(inverse, inverse)), sums.variance_out + row + x);
  }
}

/// Mean of a plane times how far its depth lies beyond the slope: seen from the neighbour behind,
/// the pixel lies as far on the other side.
HWY_INLINE void add_shifted(const WeightedSums& sums, const RowPairs& pairs, int width,
                            std::ptrdiff_t row, const float* inverse_sum) {
  for (int x = 0; x < width; x += lanes_of()) {
    const float* const at = sums.shifted_in + row + x;
    Vector sum = hn::Zero(Floats());
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const std::ptrdiff_t away = pairs.away.data()[i];
      sum = hn::MulAdd(load(pairs.ahead.data()[i] + x), load(at + away), sum);
      sum = hn::NegMulAdd(load(pairs.behind.data()[i] + x), load(at - away), sum);
    }
    store(hn::Mul(sum, load(inverse_sum + x)), sums.shifted_out + row + x);
  }
}

void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights) {
  float* const inverse_sum = weights.scratch;
  for (int r = 0; r < strip.rows; ++r) {
    const std::ptrdiff_t row = (strip.first_row + r) * grid.stride;
    const RowPairs pairs = pairs_of_row(grid, strip, weights.weight, weights.stride, r);
    add_variances(sums, pairs, grid.width, row, inverse_sum);
    int k = 0;
    for (; k + 4 <= sums.planes; k += 4)
      add_planes<4>(sums, k, pairs, grid.width, row, inverse_sum);
    for (; k + 2 <= sums.planes; k += 2)
      add_planes<2>(sums, k, pairs, grid.width, row, inverse_sum);
    for (; k < sums.planes; ++k) add_planes<1>(sums, k, pairs, grid.width, row, inverse_sum);
    if (!sums.shifted_in) continue;
    add_shifted(sums, pairs_of_row(grid, strip, weights.shifted, weights.stride, r), grid.width,
                row, inverse_sum);
  }
}

void find_energy(const std::array<const float*, max_measurements>& u, int rank,
                 const float* variance, const float* floor, float floor_share,
                 const FilterGrid& grid, int first_row, int rows, float* energy,
                 float* inverse_sigma) {
  for (int y = first_row; y < first_row + rows; ++y)
    for (int x = 0; x < grid.width; x += lanes_of()) {
      const std::ptrdiff_t p = y * grid.stride + x;
      Vector squares = hn::Zero(Floats());
      for (int j = 0; j < rank; ++j) {
        const Vector value = load(u.data()[j] + p);
        squares = hn::MulAdd(value, value, squares);
      }
      const Vector least = hn::Mul(load(floor + p), all(floor_share));
      const Vector v = hn::Max(hn::Max(load(variance + p), least), all(1e-12f));
      const Vector inverse = hn::Div(all(1.0f), v);
      store(hn::Mul(squares, inverse), energy + p);
      store(hn::Sqrt(inverse), inverse_sigma + p);
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(weigh_similar);
HWY_EXPORT(weigh_along_slopes);
HWY_EXPORT(find_slopes);
HWY_EXPORT(add_weighted);
HWY_EXPORT(find_energy);

namespace {
std::size_t row_floats(const FilterGrid& grid) { return static_cast<std::size_t>(grid.stride); }
}  // namespace

std::size_t weight_floats(const FilterGrid& grid, const FilterStrip& strip) {
  return half_window.size() * static_cast<std::size_t>(strip.rows + strip.rows_above()) *
         row_floats(grid);
}

std::size_t scratch_floats(const FilterGrid& grid, const FilterStrip& strip) {
  return static_cast<std::size_t>(strip.rows + strip.rows_above() + 2 * patch_reach + 1) *
         row_floats(grid);
}

void weigh_similar(const SimilarityTest& test, const FilterGrid& grid, const FilterStrip& strip,
                   const PairWeights& weights) {
  HWY_DYNAMIC_DISPATCH(weigh_similar)(test, grid, strip, weights);
}

void weigh_along_slopes(const SlopeTest& test, const FilterGrid& grid, const FilterStrip& strip,
                        const PairWeights& weights) {
  HWY_DYNAMIC_DISPATCH(weigh_along_slopes)(test, grid, strip, weights);
}

void find_slopes(const SlopeTest& test, const FilterGrid& grid, int first_row, int rows,
                 float* slope_x, float* slope_y) {
  HWY_DYNAMIC_DISPATCH(find_slopes)(test, grid, first_row, rows, slope_x, slope_y);
}

void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights) {
  HWY_DYNAMIC_DISPATCH(add_weighted)(sums, grid, strip, weights);
}

void find_energy(const std::array<const float*, max_measurements>& u, int rank,
                 const float* variance, const float* floor, float floor_share,
                 const FilterGrid& grid, int first_row, int rows, float* energy,
                 float* inverse_sigma) {
  HWY_DYNAMIC_DISPATCH(find_energy)
  (u, rank, variance, floor, floor_share, grid, first_row, rows, energy, inverse_sigma);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/filter_kernel.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/filter/filter_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/filter/own_light-inl.hpp"
#include "decode/filter/pair_weight-inl.hpp"
#include "decode/filter/row_pairs-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

/// Computes lambda for pixels and their neighbours at offset `away`; rank - 1 if one of them is not
/// usable.
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
    // (sum - root) / 2 would cancel for large, nearly equal a and b.
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
  const PatchScale scale(test.rank, reach);
  const Vector by = all(scale.by), expected = all(scale.expected);
  const Vector inverse_max = all(1.0f / test.max_difference_sigma);
  const Vector noise_limit = all(scale.noise_limit);
  const int rows = strip.rows + strip.rows_above();
  const int scratch_rows = rows + 2 * patch_reach;
  float* const lambda = weights.scratch;
  float* const sums = lambda + scratch_rows * weights.stride;
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    const int down = half_window[i].rows * strip.step, right = half_window[i].columns * strip.step;
    const std::ptrdiff_t away = down * grid.stride + right;
    const int top = strip.first_row - down;
    const int test_rows = strip.rows + down + 2 * reach;
    for (int r = 0; r < test_rows; ++r) {
      float* const row = lambda + r * weights.stride;
      test_row(test, (top - reach + r) * grid.stride - reach, away, grid.width + 2 * reach, row);
      float* const sum = sums + r * weights.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        Vector s = load(row + x);
        for (int n = 1; n < side; ++n) s = hn::Add(s, load(row + x + n));
        store(s, sum + x);
      }
    }
    for (int r = 0; r < strip.rows + down; ++r) {
      float* const row =
          weights.weight +
          (static_cast<std::ptrdiff_t>(i) * rows + r + strip.rows_above() - down) * weights.stride;
      clear_margins(grid, row);
      const std::ptrdiff_t at = (top + r) * grid.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        Vector s = load(sums + r * weights.stride + x);
        for (int n = 1; n < side; ++n) s = hn::Add(s, load(sums + (r + n) * weights.stride + x));
        // Only differences too large for noise count: a pair's own noise must not select it.
        const Vector own = load(lambda + (r + reach) * weights.stride + x + reach);
        s = hn::Sub(s, hn::Min(own, noise_limit));
        const Vector w = weight_of(hn::MulSub(s, by, expected), inverse_max);
        const Vector both = hn::Mul(load(test.usable + at + x), load(test.usable + at + x + away));
        store(hn::Mul(w, both), row + grid.margin + x);
      }
    }
  }
}

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

/// Returns the number of rows or columns of a window around `at` that are inside the frame.
HWY_INLINE Vector places_inside(Vector at, int size, int step) {
  const Vector one = all(1.0f);
  Vector places = one;
  for (int i = 1; i <= window_reach; ++i) {
    const auto first = static_cast<float>(i * step), end = static_cast<float>(size) - first;
    places = hn::Add(places, hn::IfThenElseZero(hn::Ge(at, all(first)), one));
    places = hn::Add(places, hn::IfThenElseZero(hn::Lt(at, all(end)), one));
  }
  return places;
}

/// Returns the rejected share of the neighbours of pixels of row y. Pixels without a usable
/// measurement count as rejected, pixels outside of the frame do not.
HWY_INLINE Vector rejected_share(const FilterGrid& grid, const FilterStrip& strip,
                                 const RowPairs& pairs, int y, int x) {
  const Vector one = all(1.0f);
  Vector sum = hn::Zero(Floats());
  for (std::size_t i = 0; i < half_window.size(); ++i)
    sum = hn::Add(sum, hn::Add(load(pairs.ahead.data()[i] + x), load(pairs.behind.data()[i] + x)));
  const Vector rows = places_inside(all(static_cast<float>(y)), grid.height, strip.step);
  const Vector columns =
      places_inside(hn::Iota(Floats(), static_cast<float>(x)), grid.width, strip.step);
  const Vector others = hn::Max(hn::MulSub(rows, columns, one), one);
  return hn::Sub(one, hn::Div(sum, others));
}

/// Adds the bound on the squared bias to the variances of a row.
HWY_INLINE void add_bias(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                         const RowPairs& pairs, int y) {
  const std::ptrdiff_t row = y * grid.stride;
  const Vector zero = hn::Zero(Floats());
  const Vector share = all(sums.bias.share), by_noise = all(sums.bias.by_noise);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const Vector rejected =
        hn::Max(hn::Sub(rejected_share(grid, strip, pairs, y, x), by_noise), zero);
    float* const variance = sums.variance_out + row + x;
    const Vector removed = hn::Max(hn::Sub(load(sums.variance + row + x), load(variance)), zero);
    store(hn::MulAdd(hn::Mul(rejected, share), removed, load(variance)), variance);
  }
}

/// Computes the mean of a plane multiplied by its depth beyond the slope, which has the opposite
/// sign for neighbours behind.
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

/// Layout: inverse sums, then the row's own weights and shifts.
BalancedRow balanced_row(const FilterGrid& grid, const FilterStrip& strip,
                         const PairWeights& weights, int r) {
  constexpr auto both_ways = static_cast<std::ptrdiff_t>(2 * half_window.size());
  float* const own = weights.scratch + weights.stride;
  return {pairs_of_row(grid, strip, weights.weight, weights.stride, r),
          pairs_of_row(grid, strip, weights.shifted, weights.stride, r), own,
          own + both_ways * weights.stride, weights.stride};
}

void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int r) {
  const std::ptrdiff_t row = (strip.first_row + r) * grid.stride;
  float* const inverse_sum = weights.scratch;
  RowPairs pairs = pairs_of_row(grid, strip, weights.weight, weights.stride, r), shifted = pairs;
  if (sums.shifted_in) shifted = pairs_of_row(grid, strip, weights.shifted, weights.stride, r);
  if (sums.balance) {
    const BalancedRow balanced = balanced_row(grid, strip, weights, r);
    balance_row(sums, balanced, grid.width, row);
    pairs = own_pairs(pairs, balanced.own_weights, balanced.stride);
    shifted = own_pairs(shifted, balanced.own_shifted, balanced.stride);
  }
  add_variances(sums, pairs, grid.width, row, inverse_sum);
  const int y = strip.first_row + r;
  if (sums.bias.share > 0.0f) add_bias(sums, grid, strip, pairs, y);
  if (sums.rejected)
    for (int x = 0; x < grid.width; x += lanes_of())
      store(rejected_share(grid, strip, pairs, y, x), sums.rejected + row + x);
  int k = 0;
  for (; k + 5 <= sums.planes; k += 5) add_planes<5>(sums, k, pairs, grid.width, row, inverse_sum);
  for (; k + 4 <= sums.planes; k += 4) add_planes<4>(sums, k, pairs, grid.width, row, inverse_sum);
  for (; k + 2 <= sums.planes; k += 2) add_planes<2>(sums, k, pairs, grid.width, row, inverse_sum);
  for (; k < sums.planes; ++k) add_planes<1>(sums, k, pairs, grid.width, row, inverse_sum);
  if (sums.shifted_in) add_shifted(sums, shifted, grid.width, row, inverse_sum);
}

void find_offsets(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int r, float* offset2) {
  constexpr float farthest2 = window_reach * window_reach;
  const std::ptrdiff_t row = (strip.first_row + r) * grid.stride;
  RowPairs pairs = pairs_of_row(grid, strip, weights.weight, weights.stride, r);
  if (sums.balance)
    pairs = own_pairs(pairs, balanced_row(grid, strip, weights, r).own_weights, weights.stride);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const float* const at = sums.shifted_in + row + x;
    Vector sum = load(at), across = hn::Zero(Floats()), along = across;
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const WindowStep& step = half_window.data()[i];
      const std::ptrdiff_t away = pairs.away.data()[i];
      const Vector ahead = hn::Mul(load(pairs.ahead.data()[i] + x), load(at + away));
      const Vector behind = hn::Mul(load(pairs.behind.data()[i] + x), load(at - away));
      const Vector apart = hn::Sub(ahead, behind);
      sum = hn::Add(sum, hn::Add(ahead, behind));
      across = hn::MulAdd(apart, all(static_cast<float>(step.columns)), across);
      along = hn::MulAdd(apart, all(static_cast<float>(step.rows)), along);
    }
    const Vector squares = hn::MulAdd(across, across, hn::Mul(along, along));
    const Vector most = hn::Mul(hn::Mul(sum, sum), all(farthest2));
    const Vector least = hn::Max(hn::Mul(sum, sum), all(1e-30f));
    store(hn::Div(hn::Min(squares, most), least), offset2 + row + x);
  }
}

/// Returns true if at most own_light_share of the usable pixels around measured less than `least`.
HWY_INLINE Mask is_light_around(const OwnLightTest& test, const FilterGrid& grid, std::ptrdiff_t at,
                                Vector least) {
  Vector count = hn::Zero(Floats()), below = count;
  for (int dy = -own_light_reach; dy <= own_light_reach; ++dy)
    for (int dx = -own_light_reach; dx <= own_light_reach; ++dx) {
      const std::ptrdiff_t pixel = at + dy * grid.stride + dx;
      const Vector usable = load(test.usable + pixel);
      const Mask is_below = hn::Lt(along_added(test, at, pixel), least);
      count = hn::Add(count, usable);
      below = hn::Add(below, hn::IfThenElseZero(is_below, usable));
    }
  return hn::Le(below, hn::Mul(all(own_light_share), count));
}

bool fuses() { return HWY_NATIVE_FMA != 0; }

void find_own_light(const OwnLightTest& test, const FilterGrid& grid, int row, float* is_own) {
  constexpr float mean_noise = own_light_noise / own_light_side;  // standard deviations of a pixel
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    const Vector square = square_of(test.added.data(), test.rank, at);
    const Vector added = hn::Sqrt(square), sigma = hn::Sqrt(load(test.variance + at));
    const Vector limit = hn::Mul(all(test.limit_sigma * mean_noise), sigma);
    const Vector evident = hn::Mul(hn::Mul(all(evident_sigma), sigma), added);
    const Mask is_lit =
        hn::And(hn::Gt(square, hn::Zero(Floats())), hn::Gt(load(test.usable + at), all(0.5f)));
    const Mask is_evident =
        hn::Or(hn::Le(added, limit), hn::Ge(along_added(test, at, at), evident));
    Mask own = hn::And(is_lit, is_evident);
    const Mask is_open = hn::AndNot(is_evident, is_lit);
    if (!hn::AllFalse(Floats(), is_open)) {
      const Vector share = hn::Max(hn::Mul(all(own_light_least_sigma * mean_noise), sigma),
                                   hn::Mul(all(own_light_least_share), added));
      const Vector least =
          hn::NegMulAdd(all(own_light_below_mean), sigma, hn::Min(share, hn::Sub(added, limit)));
      own = hn::Or(own, hn::And(is_open, is_light_around(test, grid, at, hn::Mul(least, added))));
    }
    store(hn::IfThenElseZero(own, all(1.0f)), is_own + x);
  }
}

void find_energy(const SimilarityTest& test, const float* variance, const float* floor,
                 float floor_share, const FilterGrid& grid, int row, float* energy,
                 float* inverse_sigma) {
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t p = row * grid.stride + x;
    Vector squares = hn::Zero(Floats());
    for (int j = 0; j < test.rank; ++j) {
      const Vector value = load(test.u.data()[j] + p);
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
HWY_EXPORT(add_weighted);
HWY_EXPORT(find_offsets);
HWY_EXPORT(find_energy);
HWY_EXPORT(find_own_light);
HWY_EXPORT(fuses);

namespace {
constexpr double own_difference_sigma = 3.0;

std::size_t row_floats(const FilterGrid& grid) {
  return static_cast<std::size_t>(weight_stride(grid));
}
}  // namespace

PatchScale::PatchScale(int rank, int patch_reach)
    : noise_limit(chi2_limit(rank - 1, own_difference_sigma)) {
  const int side = 2 * patch_reach + 1;
  const auto others = static_cast<float>(side * side - 1);
  const auto freedom = static_cast<float>(rank - 1);
  const float deviations = std::sqrt(others / (2 * freedom));
  by = deviations / others;
  expected = freedom * deviations;
}

bool fuses_products() { return HWY_DYNAMIC_DISPATCH(fuses)(); }

std::size_t weight_floats(const FilterGrid& grid, const FilterStrip& strip) {
  return half_window.size() * static_cast<std::size_t>(strip.rows + strip.rows_above()) *
         row_floats(grid);
}

std::size_t scratch_floats(const FilterGrid& grid, const FilterStrip& strip) {
  const int of_test = 2 * (strip.rows + strip.rows_above() + 2 * patch_reach);
  constexpr auto of_sums = static_cast<int>(1 + 4 * half_window.size());
  return static_cast<std::size_t>(std::max(of_test, of_sums)) * row_floats(grid);
}

void weigh_similar(const SimilarityTest& test, const FilterGrid& grid, const FilterStrip& strip,
                   const PairWeights& weights) {
  HWY_DYNAMIC_DISPATCH(weigh_similar)(test, grid, strip, weights);
}

void add_weighted(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row) {
  HWY_DYNAMIC_DISPATCH(add_weighted)(sums, grid, strip, weights, row);
}

void find_offsets(const WeightedSums& sums, const FilterGrid& grid, const FilterStrip& strip,
                  const PairWeights& weights, int row, float* offset2) {
  HWY_DYNAMIC_DISPATCH(find_offsets)(sums, grid, strip, weights, row, offset2);
}

void find_energy(const SimilarityTest& test, const float* variance, const float* floor,
                 float floor_share, const FilterGrid& grid, int row, float* energy,
                 float* inverse_sigma) {
  HWY_DYNAMIC_DISPATCH(find_energy)
  (test, variance, floor, floor_share, grid, row, energy, inverse_sigma);
}

void find_own_light(const OwnLightTest& test, const FilterGrid& grid, int row, float* is_own) {
  HWY_DYNAMIC_DISPATCH(find_own_light)(test, grid, row, is_own);
}

}  // namespace tofsmith
#endif

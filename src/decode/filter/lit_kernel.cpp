// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/lit_kernel.hpp"

#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/filter/lit_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/filter/own_light-inl.hpp"
#include "decode/filter/pair_weight-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

void find_own_amplitude(const OwnLightTest& test, const float* variance, const FilterGrid& grid,
                        int row, float* amplitude) {
  const Vector across = all(static_cast<float>(test.rank - 1));
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    const Vector square = square_of(test.added.data(), test.rank, at);
    const Mask is_known =
        hn::And(hn::Gt(square, hn::Zero(Floats())), hn::Gt(load(test.usable + at), all(0.5f)));
    const Vector length = hn::Mul(hn::Sqrt(square), hn::Sqrt(load(test.variance + at)));
    const Vector along = hn::NegMulAdd(across, load(variance + at), along_added(test, at, at));
    store(hn::IfThenElseZero(is_known, hn::Div(along, length)), amplitude + x);
  }
}

/// Returns the light of the darkest bar. The light of a bar is the largest value over its first
/// rows.
HWY_INLINE Vector least_of_bars(const float* amplitude, const std::ptrdiff_t* points,
                                const LitBar& bar, const float* scale, Vector most) {
  Vector least = all(1e30f);
  for (int direction = 0; direction < lit_directions; ++direction) {
    Vector sum = hn::Zero(Floats()), shown = all(-1e30f);
    for (int r = 0; r < bar.depth; ++r) {
      for (int i = 0; i < bar.length; ++i)
        sum = hn::Add(sum, hn::Min(load(amplitude + *points++), most));
      shown = hn::Max(shown, hn::Mul(sum, all(scale[r])));
    }
    least = hn::Min(least, shown);
  }
  return least;
}

HWY_INLINE Vector mean_around(const float* amplitude, std::ptrdiff_t stride) {
  Vector sum = hn::Zero(Floats());
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum = hn::Add(sum, load(amplitude + dy * stride + dx));
  return hn::Mul(sum, all(1.0f / 9.0f));
}

HWY_INLINE Vector brightest_around(const float* amplitude, std::ptrdiff_t stride) {
  Vector brightest = all(-1e30f);
  for (int dy = -lit_bright_reach; dy <= lit_bright_reach; ++dy)
    for (int dx = -lit_bright_reach; dx <= lit_bright_reach; ++dx)
      brightest = hn::Max(brightest, mean_around(amplitude + dy * stride + dx, stride));
  return brightest;
}

using LitScales = std::array<std::array<float, lit_reach + 1>, lit_bars.size()>;

LitScales lit_scales() {
  LitScales scales{};
  for (std::size_t b = 0; b < lit_bars.size(); ++b)
    for (int r = 0; r < lit_bars.data()[b].depth; ++r)
      scales.data()[b].data()[r] = lit_bar_scale(lit_bars.data()[b], r + 1);
  return scales;
}

HWY_INLINE Mask is_lit_by_bars(const float* amplitude, const std::ptrdiff_t* points,
                               const LitBar& bar, const float* scale, Vector added,
                               float bar_sigma) {
  const Vector most = hn::Add(added, all(lit_excess_sigma));
  const Vector least = least_of_bars(amplitude, points, bar, scale, most);
  const Vector of_added = hn::Mul(added, all(lit_bar_share / scale[0]));
  const Vector enough = hn::Mul(added, all(bar.enough_share / scale[bar.depth - 1]));
  return hn::Ge(least, hn::Max(hn::Min(all(bar_sigma), enough), of_added));
}

void find_lit_share(const LitTest& test, const FilterGrid& grid, int row, float* share) {
  // Static: GCC 12 misaligns such arrays on the stack of AddressSanitizer.
  static const LitScales scales = lit_scales();
  const Vector one = all(1.0f);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    const float* const amplitude = test.amplitude + at;
    const Mask is_usable = hn::Gt(load(test.light->usable + at), all(0.5f));
    Mask is_lit = hn::Or(hn::Not(is_usable), hn::Ge(load(amplitude), all(lit_pixel_sigma)));
    if (hn::AllTrue(Floats(), is_lit)) {
      store(one, share + x);
      continue;
    }
    const Vector square = square_of(test.light->added.data(), test.light->rank, at);
    const Vector added = hn::Div(hn::Sqrt(square), hn::Sqrt(load(test.light->variance + at)));
    const Vector around = mean_around(amplitude, grid.stride);
    const Mask is_lit_around = hn::Or(hn::Le(added, all(lit_around_sigma)),
                                      hn::Ge(around, hn::Mul(added, all(lit_bar_share))));
    const Mask is_alone =
        hn::Gt(test.rejected ? load(test.rejected + at) : hn::Zero(Floats()), all(lit_alone_share));
    Mask can_be_lit = hn::AndNot(is_alone, is_lit_around);
    const std::ptrdiff_t* points = test.points;
    for (std::size_t b = 0; b < lit_bars.size(); ++b) {
      const LitBar& bar = lit_bars.data()[b];
      if (b == lit_small_bars && !hn::AllFalse(Floats(), hn::AndNot(is_lit, can_be_lit))) {
        const Vector above =
            hn::Sub(brightest_around(amplitude, grid.stride), all(lit_bright_sigma));
        can_be_lit = hn::And(can_be_lit, hn::Ge(around, hn::Mul(above, all(lit_bright_share))));
      }
      const Mask is_open =
          hn::And(hn::AndNot(is_lit, can_be_lit), hn::Le(added, all(bar.max_added_sigma)));
      if (!hn::AllFalse(Floats(), is_open)) {
        const Mask is_lit_here =
            is_lit_by_bars(amplitude, points, bar, scales.data()[b].data(), added, test.bar_sigma);
        is_lit = hn::Or(is_lit, hn::And(is_open, is_lit_here));
      }
      points += lit_directions * bar.depth * bar.length;
    }
    const Vector variance = load(test.variance + at);
    store(hn::IfThenElse(is_lit, one, hn::Div(variance, hn::Add(variance, square))), share + x);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(find_own_amplitude);
HWY_EXPORT(find_lit_share);

namespace {
WindowStep bar_point(int down, int right, int r, int i) {
  if (down == 0 || right == 0) return {r * down - i * right, r * right + i * down};
  const int along = i + (r + 1) / 2;  // rows of diagonals are half a step apart
  return {down * along, right * (r - along)};
}
}  // namespace

std::vector<WindowStep> lit_bar_points() {
  constexpr std::array<WindowStep, lit_directions> directions = {
      {{0, 1}, {1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}};
  std::vector<WindowStep> points;
  for (const LitBar& bar : lit_bars)
    for (const WindowStep& d : directions)
      for (int r = 0; r < bar.depth; ++r)
        for (int i = -(bar.length / 2); i <= bar.length / 2; ++i)
          points.push_back(bar_point(d.rows, d.columns, r, i));
  return points;
}

float lit_bar_scale(const LitBar& bar, int rows) {
  return 1.0f / std::sqrt(static_cast<float>(bar.length * rows));
}

void find_own_amplitude(const OwnLightTest& test, const float* variance, const FilterGrid& grid,
                        int row, float* amplitude) {
  HWY_DYNAMIC_DISPATCH(find_own_amplitude)(test, variance, grid, row, amplitude);
}

void find_lit_share(const LitTest& test, const FilterGrid& grid, int row, float* share) {
  HWY_DYNAMIC_DISPATCH(find_lit_share)(test, grid, row, share);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Weighted pairs of neighbouring pixels.
#if defined(TOFSMITH_DECODE_FILTER_ROW_PAIRS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_FILTER_ROW_PAIRS_INL_HPP
#undef TOFSMITH_DECODE_FILTER_ROW_PAIRS_INL_HPP
#else
#define TOFSMITH_DECODE_FILTER_ROW_PAIRS_INL_HPP
#endif

#include <array>

#include "decode/filter/filter_kernel.hpp"
#include "decode/filter/pair_weight-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

struct RowPairs {
  std::array<const float*, half_window.size()> ahead, behind;  // weights
  std::array<std::ptrdiff_t, half_window.size()> away;         // offset of the neighbour ahead
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

/// Returns pairs whose weights, for one row only, are stored in `room`.
RowPairs own_pairs(const RowPairs& pairs, const float* room, std::ptrdiff_t stride) {
  RowPairs own = pairs;
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    own.ahead[i] = room + static_cast<std::ptrdiff_t>(2 * i) * stride;
    own.behind[i] = room + static_cast<std::ptrdiff_t>(2 * i + 1) * stride;
  }
  return own;
}

struct BalancedRow {
  RowPairs weights, shifted;         // as stored for the strip
  float *own_weights, *own_shifted;  // of this row only
  std::ptrdiff_t stride;
};

/// Limits the weighted light of a neighbour to `balanced_light` times that of the opposite one.
HWY_INLINE Vector share_of_light(Vector light, Vector opposite) {
  const Vector most = hn::Mul(all(balanced_light), opposite);
  return hn::Min(hn::Div(most, hn::Max(light, all(1e-30f))), all(1.0f));
}

/// Balances noise and the error of slopes (see LightBalance).
HWY_INLINE void balance_row(const WeightedSums& sums, const BalancedRow& pairs, int width,
                            std::ptrdiff_t row) {
  const LightBalance& balance = *sums.balance;
  const Vector zero = hn::Zero(Floats()), one = all(1.0f), tiny = all(1e-30f);
  constexpr float farthest2 = window_reach * window_reach;
  const auto step = static_cast<float>(balance.step);
  const Vector by = all(slope_error_share * slope_error_share * step * step);
  const Indices di;
  for (int x = 0; x < width; x += lanes_of()) {
    const float* const signal = sums.shifted_in + row + x;
    const float* const variance = sums.variance + row + x;
    Vector light = load(signal), noise = load(variance);
    Vector light_balanced = light, noise_balanced = noise, across = zero, along = zero;
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const WindowStep& place = half_window.data()[i];
      const std::ptrdiff_t away = pairs.weights.away.data()[i];
      const Vector ahead = load(pairs.weights.ahead.data()[i] + x),
                   behind = load(pairs.weights.behind.data()[i] + x);
      const Vector light_ahead = hn::Mul(ahead, load(signal + away)),
                   light_behind = hn::Mul(behind, load(signal - away));
      const Vector seen_ahead = hn::Max(light_ahead, zero),
                   seen_behind = hn::Max(light_behind, zero);
      const Vector share_ahead = share_of_light(seen_ahead, seen_behind),
                   share_behind = share_of_light(seen_behind, seen_ahead);
      float* const shares = pairs.own_weights + static_cast<std::ptrdiff_t>(2 * i) * pairs.stride;
      store(share_ahead, shares + x);
      store(share_behind, shares + pairs.stride + x);
      const Vector apart = hn::Sub(light_ahead, light_behind);
      light = hn::Add(light, hn::Add(light_ahead, light_behind));
      light_balanced = hn::MulAdd(share_ahead, light_ahead, light_balanced);
      light_balanced = hn::MulAdd(share_behind, light_behind, light_balanced);
      across = hn::MulAdd(apart, all(static_cast<float>(place.columns)), across);
      along = hn::MulAdd(apart, all(static_cast<float>(place.rows)), along);
      const Vector noise_ahead = hn::Mul(hn::Mul(ahead, ahead), load(variance + away)),
                   noise_behind = hn::Mul(hn::Mul(behind, behind), load(variance - away));
      noise = hn::Add(noise, hn::Add(noise_ahead, noise_behind));
      noise_balanced = hn::MulAdd(hn::Mul(share_ahead, share_ahead), noise_ahead, noise_balanced);
      noise_balanced =
          hn::MulAdd(hn::Mul(share_behind, share_behind), noise_behind, noise_balanced);
    }
    // Squared depth error of the unbalanced sum, and the noise that balancing adds.
    const Vector light2 = hn::Max(hn::Mul(light, light), tiny),
                 balanced2 = hn::Max(hn::Mul(light_balanced, light_balanced), tiny);
    const Vector offset2 = hn::Div(
        hn::Min(hn::MulAdd(across, across, hn::Mul(along, along)), hn::Mul(light2, all(farthest2))),
        light2);
    const Vector slope_x = load(balance.slope_x + row + x),
                 slope_y = load(balance.slope_y + row + x);
    const Vector slope2 = hn::MulAdd(slope_x, slope_x, hn::Mul(slope_y, slope_y));
    auto bin = hn::ConvertTo(di, load(balance.depth + row + x));
    bin = hn::Max(hn::Min(bin, hn::Set(di, balance.samples - 1)), hn::Zero(di));
    bin = hn::Add(bin, bin);
    const Vector per_bin2 = hn::GatherIndex(Floats(), balance.squares, bin);
    const Vector length2 = hn::GatherIndex(Floats(), balance.squares + 1, bin);
    const Vector error2 = hn::Mul(hn::Mul(hn::Mul(by, offset2), slope2), per_bin2);
    const Vector more =
        hn::Max(hn::Sub(hn::Div(noise_balanced, balanced2), hn::Div(noise, light2)), zero);
    const Vector wanted = hn::Div(error2, hn::Max(hn::Add(error2, more), tiny));
    // Convert the weight of depth to light.
    const Vector of_balanced = hn::Mul(wanted, light);
    const Vector of_all = hn::Mul(hn::Sub(one, wanted), light_balanced);
    // Noise alone must not change the weights.
    const Mask is_seen = hn::Gt(hn::Mul(light2, length2), hn::Mul(all(balanced_energy), noise));
    const Mask is_lit =
        hn::And(is_seen, hn::And(hn::Gt(light, zero), hn::Gt(light_balanced, zero)));
    const Vector part = hn::IfThenElseZero(
        is_lit, hn::Div(of_balanced, hn::Max(hn::Add(of_balanced, of_all), tiny)));
    for (std::size_t i = 0; i < half_window.size(); ++i) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(2 * i) * pairs.stride + x;
      const auto keep = [&](const float* weight, const float* moved, std::ptrdiff_t to) {
        const Vector left = hn::NegMulAdd(part, hn::Sub(one, load(pairs.own_weights + to)), one);
        store(hn::Mul(load(weight + x), left), pairs.own_weights + to);
        store(hn::Mul(load(moved + x), left), pairs.own_shifted + to);
      };
      keep(pairs.weights.ahead.data()[i], pairs.shifted.ahead.data()[i], at);
      keep(pairs.weights.behind.data()[i], pairs.shifted.behind.data()[i], at + pairs.stride);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/gradients/between_bins.hpp"

#include <algorithm>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/gradients/harmonic_sums.cpp"
#include <hwy/foreach_target.h>
// Highway requires its headers after foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int tile = 16;  // harmonics in the L1 cache

struct Turns {
  alignas(64) double cosine[tile * harmonic_block];
  alignas(64) double sine[tile * harmonic_block];
  alignas(64) double first_cosine[harmonic_block], first_sine[harmonic_block];
  alignas(64) double next_cosine[harmonic_block], next_sine[harmonic_block];

  explicit Turns(const double* periods) {
    const Doubles d;
    const int lanes = lanes_of(d);
    for (int p = 0; p < harmonic_block; p += lanes) {
      const auto angle = hn::Mul(hn::LoadU(d, periods + p), all(2.0 * std::numbers::pi));
      const auto cosine_of = hn::Cos(d, angle), sine_of = hn::Sin(d, angle);
      hn::Store(cosine_of, d, first_cosine + p);
      hn::Store(sine_of, d, first_sine + p);
      hn::Store(cosine_of, d, next_cosine + p);
      hn::Store(sine_of, d, next_sine + p);
    }
  }

  HWY_INLINE void advance(int count) {
    const Doubles d;
    const int lanes = lanes_of(d);
    for (int p = 0; p < harmonic_block; p += lanes) {
      const auto c1 = hn::Load(d, first_cosine + p), s1 = hn::Load(d, first_sine + p);
      auto c = hn::Load(d, next_cosine + p), s = hn::Load(d, next_sine + p);
      for (int k = 0; k < count; ++k) {
        hn::Store(c, d, cosine + k * harmonic_block + p);
        hn::Store(s, d, sine + k * harmonic_block + p);
        const auto further = hn::NegMulAdd(s, s1, hn::Mul(c, c1));
        s = hn::MulAdd(s, c1, hn::Mul(c, s1));
        c = further;
      }
      hn::Store(c, d, next_cosine + p);
      hn::Store(s, d, next_sine + p);
    }
  }
};

/// Adds a[k] cos_k - b[k] sin_k, two vectors at a time.
HWY_INLINE void add_tile(const Turns& turns, const double* HWY_RESTRICT a,
                         const double* HWY_RESTRICT b, int count, double* HWY_RESTRICT sums) {
  const Doubles d;
  const int lanes = lanes_of(d);
  for (int p = 0; p < harmonic_block; p += 2 * lanes) {
    auto even = hn::Load(d, sums + p), odd = hn::Load(d, sums + p + lanes);
    auto even_sine = hn::Zero(d), odd_sine = hn::Zero(d);
    for (int k = 0; k < count; ++k) {
      const auto of_cosine = all(a[k]), of_sine = all(b[k]);
      const double* const cosine = turns.cosine + k * harmonic_block + p;
      const double* const sine = turns.sine + k * harmonic_block + p;
      even = hn::MulAdd(of_cosine, hn::Load(d, cosine), even);
      odd = hn::MulAdd(of_cosine, hn::Load(d, cosine + lanes), odd);
      even_sine = hn::MulAdd(of_sine, hn::Load(d, sine), even_sine);
      odd_sine = hn::MulAdd(of_sine, hn::Load(d, sine + lanes), odd_sine);
    }
    hn::Store(hn::Sub(even, even_sine), d, sums + p);
    hn::Store(hn::Sub(odd, odd_sine), d, sums + p + lanes);
  }
}

void sum_of(const HarmonicFunctions& functions, const double* periods, double* values,
            double* slopes) {
  Turns turns(periods);
  alignas(64) double sums[harmonic_block];
  const int count_of_functions = functions.functions;
  for (int f = 0; f < count_of_functions; ++f) {
    std::fill_n(values + f * harmonic_block, harmonic_block, functions.real[functions.at(0, f)]);
    if (slopes) std::fill_n(slopes + f * harmonic_block, harmonic_block, 0.0);
  }
  for (int first = 1; first < functions.harmonics; first += tile) {
    const int count = std::min(tile, functions.harmonics - first);
    turns.advance(count);
    for (int f = 0; f < count_of_functions; ++f) {
      double a[tile], b[tile];
      for (int k = 0; k < count; ++k) {
        a[k] = functions.real[functions.at(first + k, f)];
        b[k] = functions.imag[functions.at(first + k, f)];
      }
      const auto add = [&](double* all_sums) {
        std::copy_n(all_sums + f * harmonic_block, harmonic_block, sums);
        add_tile(turns, a, b, count, sums);
        std::copy_n(sums, harmonic_block, all_sums + f * harmonic_block);
      };
      add(values);
      if (!slopes) continue;
      for (int k = 0; k < count; ++k) {  // -2 pi n (a sin + b cos)
        const double turn = -2.0 * std::numbers::pi * (first + k);
        const double of_cosine = turn * b[k];
        b[k] = -turn * a[k];
        a[k] = of_cosine;
      }
      add(slopes);
    }
  }
}

void add_of(const double* periods, const double* weights, HarmonicFunctions& gradient) {
  const Doubles d;
  const int lanes = lanes_of(d);
  Turns turns(periods);
  alignas(64) double weight[harmonic_block];
  for (int f = 0; f < gradient.functions; ++f)
    for (int p = 0; p < harmonic_block; ++p)
      gradient.real[gradient.at(0, f)] += weights[f * harmonic_block + p];
  for (int first = 1; first < gradient.harmonics; first += tile) {
    const int count = std::min(tile, gradient.harmonics - first);
    turns.advance(count);
    for (int f = 0; f < gradient.functions; ++f) {
      std::copy_n(weights + f * harmonic_block, harmonic_block, weight);
      for (int k = 0; k < count; ++k) {
        auto by_cosine = hn::Zero(d), by_sine = hn::Zero(d);
        for (int p = 0; p < harmonic_block; p += lanes) {
          const auto w = hn::Load(d, weight + p);
          by_cosine = hn::MulAdd(w, hn::Load(d, turns.cosine + k * harmonic_block + p), by_cosine);
          by_sine = hn::MulAdd(w, hn::Load(d, turns.sine + k * harmonic_block + p), by_sine);
        }
        gradient.real[gradient.at(first + k, f)] += sum_of_lanes(d, by_cosine);
        gradient.imag[gradient.at(first + k, f)] -= sum_of_lanes(d, by_sine);
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(sum_of);
HWY_EXPORT(add_of);

void sum_harmonics(const HarmonicFunctions& functions, const double* periods, double* values,
                   double* slopes) {
  HWY_DYNAMIC_DISPATCH(sum_of)(functions, periods, values, slopes);
}

void add_harmonics(const double* periods, const double* weights, HarmonicFunctions& gradient) {
  HWY_DYNAMIC_DISPATCH(add_of)(periods, weights, gradient);
}

}  // namespace tofsmith
#endif

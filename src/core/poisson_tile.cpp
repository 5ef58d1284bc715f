// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/shared/random.hpp"
#include "core/shared/random_tile.hpp"

#ifndef TOFSMITH_CORE_POISSON_TILE_CONSTANTS
#define TOFSMITH_CORE_POISSON_TILE_CONSTANTS
namespace tofsmith {
namespace {
constexpr double min_stirling_count = 16.0;
}  // namespace
}  // namespace tofsmith
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/poisson_tile.cpp"
#include <hwy/foreach_target.h>
// Highway requires its own headers after foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

using Double = DoubleVector;

/// Uniform in (0, 1).
HWY_INLINE Double open_uniform(const std::uint32_t* word) {
  const Doubles d;
  const hn::Rebind<std::uint32_t, Doubles> narrow;
  const auto wide = hn::PromoteTo(hn::RebindToUnsigned<Doubles>(), hn::LoadU(narrow, word));
  const Double number = hn::ConvertTo(d, hn::BitCast(hn::RebindToSigned<Doubles>(), wide));
  return hn::Mul(hn::Add(number, all(0.5)), all(0x1p-32));
}

/// Vector of attempts, see attempted_poisson().
struct Attempt {
  HWY_INLINE Attempt(const std::uint32_t* u_word, const std::uint32_t* v_word, const double* means)
      : mean(hn::Max(hn::LoadU(Doubles(), means), all(min_rejection_mean))),
        b(hn::MulAdd(all(2.53), hn::Sqrt(mean), all(0.931))),
        a(hn::MulAdd(all(0.02483), b, all(-0.059))),
        v(open_uniform(v_word)) {
    const Double u = hn::Sub(open_uniform(u_word), all(0.5));
    us = hn::Sub(all(0.5), hn::Abs(u));
    const Double slope = hn::Add(hn::Div(hn::Add(a, a), us), b);
    k = hn::Floor(hn::Add(hn::MulAdd(slope, u, mean), all(0.43)));
  }
  /// Accepted without evaluating the density (four in five): v <= 0.9277 - 3.6224 / (b - 2).
  HWY_INLINE auto is_quick() const {
    const Double room = hn::Sub(b, all(2.0));
    const auto is_low = hn::Le(hn::Mul(v, room), hn::MulAdd(all(0.9277), room, all(-3.6224)));
    return hn::And(hn::Ge(us, all(0.07)), is_low);
  }
  /// Accepted by the density; requires k >= 16, where Stirling's series is exact.
  HWY_INLINE auto is_below_density() const {
    const Doubles d;
    const Double inverse_alpha = hn::Add(all(1.1239), hn::Div(all(1.1328), hn::Sub(b, all(3.4))));
    const Double hat = hn::Add(hn::Div(a, hn::Mul(us, us)), b);
    const Double height = hn::Div(hn::Mul(v, inverse_alpha), hat);
    const Double n = hn::Max(k, all(16.0)), r = hn::Div(all(1.0), n), r2 = hn::Mul(r, r);
    Double series = hn::MulAdd(r2, all(-1.0 / 1680), all(1.0 / 1260));
    series = hn::NegMulAdd(r2, series, all(1.0 / 360));
    series = hn::Mul(r, hn::NegMulAdd(r2, series, all(1.0 / 12)));
    // ln height <= n ln(mean / n) - mean + n - ln(2 pi n) / 2 - series
    const Double scaled = hn::Mul(height, hn::Sqrt(n));
    Double right = hn::MulAdd(n, hn::Log(d, hn::Mul(mean, r)), hn::Sub(n, mean));
    right = hn::Sub(hn::Sub(right, all(0.91893853320467274178)), series);
    return hn::Le(hn::Log(d, scaled), right);
  }

  Double mean, b, a, v, us, k;
};

template <typename Mask>
HWY_INLINE void store_mask(Mask mask, std::uint8_t* is_so) {
  alignas(64) double one[8];
  hn::Store(hn::IfThenElseZero(mask, all(1.0)), Doubles(), one);
  for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) is_so[lane] = one[lane] > 0.0;
}

/// Counts with a mean below 10 are meaningless and drawn otherwise.
void quick_poisson(const std::uint32_t* u_word, const std::uint32_t* v_word, int trials,
                   const double* mean, double* count, std::uint8_t* is_accepted) {
  for (int i = 0; i < trials; i += lanes_of(Doubles())) {
    const Attempt attempt(u_word + i, v_word + i, mean + i);
    hn::StoreU(attempt.k, Doubles(), count + i);
    store_mask(attempt.is_quick(), is_accepted + i);
  }
}

/// Acceptance is not valid for counts below 16.
void full_poisson(const std::uint32_t* u_word, const std::uint32_t* v_word, int trials,
                  const double* mean, double* count, std::uint8_t* is_accepted) {
  for (int i = 0; i < trials; i += lanes_of(Doubles())) {
    const Attempt attempt(u_word + i, v_word + i, mean + i);
    hn::StoreU(attempt.k, Doubles(), count + i);
    const auto is_out = hn::And(hn::Lt(attempt.us, all(0.013)), hn::Gt(attempt.v, attempt.us));
    store_mask(hn::Or(attempt.is_quick(), hn::AndNot(is_out, attempt.is_below_density())),
               is_accepted + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(quick_poisson);
HWY_EXPORT(full_poisson);

namespace {

constexpr std::uint32_t first_poisson_block = 1u << 30;
constexpr std::uint32_t blocks_per_draw = 1u << 18;

std::uint32_t block_of(int draw, std::uint32_t number) {
  return first_poisson_block + static_cast<std::uint32_t>(draw) * blocks_per_draw + number;
}

/// Trials without an accepted count.
struct OpenTrials {
  int size = 0;
  std::array<int, trials_per_tile> trial;
  std::array<double, trials_per_tile> mean, count;
  alignas(64) std::array<std::uint32_t, trials_per_tile> u_word, v_word;
  std::array<std::uint8_t, trials_per_tile> is_accepted;

  void add(int i, double mean_) {
    trial[static_cast<std::size_t>(size)] = i;
    mean[static_cast<std::size_t>(size++)] = mean_;
  }
  /// One attempt per trial; accepted counts move to `counts`.
  void attempt(double* counts) {
    for (std::size_t i = static_cast<std::size_t>(size); i % 8 != 0; ++i) {
      mean[i] = min_rejection_mean;  // fills the last vector
      u_word[i] = v_word[i] = 0;
    }
    HWY_DYNAMIC_DISPATCH(full_poisson)
    (u_word.data(), v_word.data(), size, mean.data(), count.data(), is_accepted.data());
    const int before = size;
    size = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(before); ++i) {
      const bool is_few = count[i] < min_stirling_count;
      if (is_few ? attempted_poisson(mean[i], u_word[i], v_word[i]).has_value()
                 : is_accepted[i] != 0)
        counts[trial[i]] = count[i];
      else
        add(trial[i], mean[i]);
    }
  }
};

}  // namespace

void draw_poisson(const TrialStreams& streams, int draw, int trials, const double* mean,
                  double* count) {
  alignas(64) std::uint32_t words[4 * trials_per_tile];
  std::uint8_t is_accepted[trials_per_tile];
  draw_words(streams, block_of(draw, 0), trials, words);
  HWY_DYNAMIC_DISPATCH(quick_poisson)
  (words, words + trials_per_tile, trials, mean, count, is_accepted);

  OpenTrials open;
  for (int i = 0; i < trials; ++i) {
    if (mean[i] < min_rejection_mean)
      count[i] =
          mean[i] > 0.0 ? inverted_poisson(mean[i], words[i], words[trials_per_tile + i]) : 0.0;
    else if (is_accepted[i] == 0)
      open.add(i, mean[i]);
  }
  for (std::uint32_t attempt = 0; open.size > 0; ++attempt) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(open.size); ++i) {
      const int trial = open.trial[i];
      const std::uint32_t first = attempt % 2 * 2;
      const auto word = [&](std::uint32_t w) {
        return words[static_cast<int>(w) * trials_per_tile + trial];
      };
      if (attempt < 2) {
        open.u_word[i] = word(first);
        open.v_word[i] = word(first + 1);
      } else {
        RandomStream more(streams.seed, streams.work_item,
                          streams.first_trial + static_cast<std::uint32_t>(trial),
                          block_of(draw, attempt / 2));
        for (std::uint32_t word_before = 0; word_before < first; ++word_before) more();
        open.u_word[i] = more();
        open.v_word[i] = more();
      }
    }
    open.attempt(count);
  }
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/random_tile.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/random_tile.cpp"
#include <hwy/foreach_target.h>
// Highway requires its own header after foreach_target, and this file's header first.
#include <hwy/highway.h>

#include "core/shared/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

// Philox4x32 (Salmon et al., SC 2011): multipliers of words 0 and 2, and increments of the keys.
constexpr std::uint32_t multiplier_0 = 0xD2511F53, multiplier_2 = 0xCD9E8D57;
constexpr std::uint32_t step_0 = 0x9E3779B9, step_1 = 0xBB67AE85;
constexpr int rounds = 10;

/// Only the lower halves are used.
using Wide = hn::CappedTag<std::uint64_t, 8>;
using WideVector = hn::Vec<Wide>;

HWY_INLINE WideVector product(WideVector a, std::uint32_t b) {
#if HWY_TARGET == HWY_SCALAR
  const Wide d;
  return hn::Set(d, (hn::GetLane(a) & 0xffffffffu) * b);
#else
  const hn::Repartition<std::uint32_t, Wide> narrow;
  return hn::MulEven(hn::BitCast(narrow, a), hn::Set(narrow, b));
#endif
}

HWY_INLINE void philox(std::uint64_t seed, WideVector& x0, WideVector& x1, WideVector& x2,
                       WideVector& x3) {
  const Wide d;
  auto key_0 = static_cast<std::uint32_t>(seed), key_1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < rounds; ++round) {
    const auto p0 = product(x0, multiplier_0), p2 = product(x2, multiplier_2);
    x0 = hn::Xor(hn::Xor(hn::ShiftRight<32>(p2), x1), hn::Set(d, key_0));
    x2 = hn::Xor(hn::Xor(hn::ShiftRight<32>(p0), x3), hn::Set(d, key_1));
    x1 = p2;
    x3 = p0;
    key_0 += step_0;
    key_1 += step_1;
  }
}

void words(const TrialStreams& streams, std::uint32_t block, int trials, std::uint32_t* to) {
  const Wide d;
  const hn::Rebind<std::uint32_t, Wide> narrow;
  const int lanes = lanes_of(d);
  const auto draw = hn::Set(d, block);
  const auto item_low = hn::Set(d, streams.work_item & 0xffffffffu);
  const auto item_high = hn::Set(d, streams.work_item >> 32);
  auto trial = hn::Iota(d, streams.first_trial);
  // Two vectors hide the latency of multiplications.
  for (int i = 0; i < trials; i += 2 * lanes) {
    const auto next = hn::Add(trial, hn::Set(d, static_cast<std::uint64_t>(lanes)));
    WideVector a0 = draw, a1 = trial, a2 = item_low, a3 = item_high;
    WideVector b0 = draw, b1 = next, b2 = item_low, b3 = item_high;
    philox(streams.seed, a0, a1, a2, a3);
    philox(streams.seed, b0, b1, b2, b3);
    const auto store = [&](WideVector a, WideVector b, int word) {
      std::uint32_t* const row = to + word * trials_per_tile + i;
      hn::StoreU(hn::TruncateTo(narrow, a), narrow, row);
      hn::StoreU(hn::TruncateTo(narrow, b), narrow, row + lanes);
    };
    store(a0, b0, 0);
    store(a1, b1, 1);
    store(a2, b2, 2);
    store(a3, b3, 3);
    trial = hn::Add(next, hn::Set(d, static_cast<std::uint64_t>(lanes)));
  }
}

void normals(const std::uint32_t* radius, const std::uint32_t* angle, int trials, float* first,
             float* second) {
  const Floats d;
  const hn::RebindToUnsigned<Floats> du;
  for (int i = 0; i < trials; i += lanes_of(d)) {
    const auto length = normal_radius(hn::Load(du, radius + i));
    Vector cosine, sine;
    unit_circle(hn::Load(du, angle + i), cosine, sine);
    hn::Store(hn::Mul(length, cosine), d, first + i);
    hn::Store(hn::Mul(length, sine), d, second + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(words);
HWY_EXPORT(normals);

void draw_words(const TrialStreams& streams, std::uint32_t block, int trials, std::uint32_t* to) {
  HWY_DYNAMIC_DISPATCH(words)(streams, block, trials, to);
}

void normals_of(const std::uint32_t* radius, const std::uint32_t* angle, int trials, float* first,
                float* second) {
  HWY_DYNAMIC_DISPATCH(normals)(radius, angle, trials, first, second);
}

}  // namespace tofsmith
#endif

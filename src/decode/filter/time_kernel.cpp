// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/time_kernel.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/filter/time_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

// Loops for automatic vectorization. Products are not fused with additions, so that all instruction
// sets give the same bits.
HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int block = TimeFilter::State::block_pixels;
using Block = std::array<float, block>;

/// Compilers do not vectorize sqrt() in loops (errno).
void take_roots(float* values) {
  for (int i = 0; i < block; i += lanes_of())
    hn::StoreU(hn::Sqrt(hn::LoadU(Floats(), values + i)), Floats(), values + i);
}

void find_usable(const TimeFilter::State& s, const AddedFrames& added, const ComparedPixels& c) {
  const auto [lowest, highest] = s.levels;
  const float* const past = added.averaged.pixels.data() + c.first;
  for (int i = 0; i < c.pixels; ++i)
    c.usable[i] = (c.averaged_now[i] > 0.0f) & (past[i] > 0.0f) ? 1.0f : 0.0f;
  for (int k = 0; k < s.measurements; ++k) {
    const float* const now = c.now + k * block;
    const float* const before = s.mean(added, k, c.first);
    for (int i = 0; i < c.pixels; ++i) {
      // Comparisons with NaN are false.
      const bool is_light =
          (now[i] > lowest) & (before[i] > lowest) & (now[i] < highest) & (before[i] < highest);
      c.usable[i] = is_light ? c.usable[i] : 0.0f;
    }
  }
}

/// Estimates the signal of both frames for its noise, if light cancels in the measurements.
void find_signal(const TimeFilter::State& s, const AddedFrames& added, const ComparedPixels& c,
                 Block& signal) {
  Block squares{}, along;
  const float* const past = added.averaged.pixels.data() + c.first;
  for (int j = 0; j < static_cast<int>(s.hidden.rank); ++j) {
    along.fill(0.0f);
    for (int k = 0; k < s.measurements; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const float by = s.to_plane.data()[std::ptrdiff_t{j} * s.measurements + k] * s.gain[at];
      const float dark = s.dark_raw[at];
      const float* const now = c.now + k * block;
      const float* const before = s.mean(added, k, c.first);
      for (int i = 0; i < c.pixels; ++i) {
        const float n = c.averaged_now[i];
        const float both = (before[i] * past[i] + now[i] * n) / (past[i] + n);
        along.data()[i] += by * (both - dark);
      }
    }
    for (int i = 0; i < c.pixels; ++i) squares.data()[i] += along.data()[i] * along.data()[i];
  }
  for (int i = 0; i < c.pixels; ++i)
    signal.data()[i] = s.hidden.of(squares.data()[i], past[i] + c.averaged_now[i]);
}

void compare_pixels(const TimeFilter::State& s, const AddedFrames& added, const ComparedPixels& c) {
  find_usable(s, added, c);
  Block signal, chi2{}, sigma{};
  if (s.has_own_shot_noise) find_signal(s, added, c, signal);
  const float* const past = added.averaged.pixels.data() + c.first;
  for (int k = 0; k < s.measurements; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const float gain = s.gain[at], dark = s.dark_raw[at], floor = s.floor_variance_e2[at],
                per_signal = s.shot_per_signal[at];
    const float* const now = c.now + k * block;
    const float* const before = s.mean(added, k, c.first);
    float* const difference = c.difference + k * c.difference_stride;
    for (int i = 0; i < c.pixels; ++i) {
      const float n = c.averaged_now[i];
      const float both = (before[i] * past[i] + now[i] * n) / (past[i] + n);
      const float light = std::max(0.0f, (both - dark) * gain);
      sigma.data()[i] = (floor + light) * (1.0f / past[i] + 1.0f / n);
    }
    if (s.has_own_shot_noise)
      for (int i = 0; i < c.pixels; ++i)
        sigma.data()[i] =
            (floor + signal.data()[i] * per_signal) * (1.0f / past[i] + 1.0f / c.averaged_now[i]);
    take_roots(sigma.data());
    for (int i = 0; i < c.pixels; ++i) {
      const float d = (now[i] - before[i]) * gain / sigma.data()[i];
      difference[i] = c.usable[i] > 0.0f ? d : 0.0f;
    }
    for (int i = 0; i < c.pixels; ++i) chi2.data()[i] += difference[i] * difference[i];
  }
  for (int i = 0; i < c.pixels; ++i) c.chi2[i] = c.usable[i] > 0.0f ? chi2.data()[i] : c.chi2[i];
}

void add_columns(const float* values, int pixels, float* sums) {
  static_assert(patch_reach == 2);
  for (int i = 0; i < pixels; ++i)
    sums[i] = values[i - 2] + values[i - 1] + values[i] + values[i + 1] + values[i + 2];
}

void weigh_pixels(const TimeFilter::State& s, const WeighedPixels& w) {
  Block patch_chi2, counts, sum, shared{};
  add_columns(w.patch_chi2, w.pixels, patch_chi2.data());
  add_columns(w.counts, w.pixels, counts.data());
  for (int k = 0; k < s.measurements; ++k) {
    add_columns(w.difference + k * w.difference_stride, w.pixels, sum.data());
    for (int i = 0; i < w.pixels; ++i) shared.data()[i] += sum.data()[i] * sum.data()[i];
  }
  const auto freedom = static_cast<float>(s.measurements);
  const auto max_weight = static_cast<float>(s.options.max_frames - 1);
  const ChangeTest pixel = s.pixel_test, patch = s.patch_test, common = s.shared_test;
  for (int i = 0; i < w.pixels; ++i) {
    const float n = w.averaged_now ? w.averaged_now[i] : 1.0f;
    const float past = w.past[i];
    const float own_chi2 = w.own_chi2[i], all_chi2 = patch_chi2.data()[i];
    const float common_chi2 = shared.data()[i] / std::max(counts.data()[i], 1.0f);
    const float share =
        std::min(std::min(pixel.share(own_chi2), patch.share(all_chi2)), common.share(common_chi2));
    const float beyond =
        std::max(std::max(pixel.beyond(own_chi2), patch.beyond(all_chi2) / patch_pixels),
                 common.beyond(common_chi2) / patch_pixels);
    const float changed = (1.0f / past + 1.0f / n) / freedom * beyond;
    const float stays = share * past / (1.0f + past * changed);
    w.weight[i] = w.usable[i] > 0.0f ? std::min(stays, max_weight * n) : w.none;
    w.unchanged[i] = changed > 0.0f ? 0.0f : w.usable[i];
  }
}

void add_pixels(const float* HWY_RESTRICT now, const float* HWY_RESTRICT averaged_now,
                const float* HWY_RESTRICT weight, int measurements, int pixels,
                float* HWY_RESTRICT mean, std::ptrdiff_t mean_stride,
                float* HWY_RESTRICT averaged) {
  Block share;
  for (int i = 0; i < pixels; ++i) share.data()[i] = weight[i] / (weight[i] + averaged_now[i]);
  for (int k = 0; k < measurements; ++k) {
    const float* const from = now + k * block;
    float* const to = mean + k * mean_stride;
    for (int i = 0; i < pixels; ++i) {
      const float both = from[i] + (to[i] - from[i]) * share.data()[i];
      to[i] = weight[i] > 0.0f ? both : from[i];
    }
  }
  for (int i = 0; i < pixels; ++i) {
    const float w = weight[i], n = averaged_now[i];
    const float both = (w + n) * (w + n) / (w * w / averaged[i] + n);
    averaged[i] = w > 0.0f ? both : n;
  }
}

void add_to_sums(const float* HWY_RESTRICT values, std::ptrdiff_t count, float* HWY_RESTRICT sums) {
  for (std::ptrdiff_t i = 0; i < count; ++i) sums[i] += values[i];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(compare_pixels);
HWY_EXPORT(weigh_pixels);
HWY_EXPORT(add_pixels);
HWY_EXPORT(add_to_sums);

void compare_pixels(const TimeFilter::State& state, const AddedFrames& added,
                    const ComparedPixels& compared) {
  HWY_DYNAMIC_DISPATCH(compare_pixels)(state, added, compared);
}

void weigh_pixels(const TimeFilter::State& state, const WeighedPixels& weighed) {
  HWY_DYNAMIC_DISPATCH(weigh_pixels)(state, weighed);
}

void add_pixels(const float* now, const float* averaged_now, const float* weight, int measurements,
                int pixels, float* mean, std::ptrdiff_t mean_stride, float* averaged) {
  HWY_DYNAMIC_DISPATCH(add_pixels)
  (now, averaged_now, weight, measurements, pixels, mean, mean_stride, averaged);
}

void add_to_sums(const float* values, std::ptrdiff_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(add_to_sums)(values, count, sums);
}

}  // namespace tofsmith
#endif

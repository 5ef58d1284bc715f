// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "decode/filter/time_filter_state.hpp"

namespace tofsmith {

/// Inputs and outputs of compare_pixels() for a block of a row, (K,
/// TimeFilter::State::block_pixels).
struct ComparedPixels {
  const float* now = nullptr;
  const float* averaged_now = nullptr;
  std::ptrdiff_t first = 0;  ///< in the frame
  int pixels = 0;
  float* usable = nullptr;               ///< 1 if both values are valid, else 0
  float* difference = nullptr;           ///< standard deviations; 0 where not usable
  std::ptrdiff_t difference_stride = 0;  ///< between measurements [floats]
  float* chi2 = nullptr;                 ///< unchanged where not usable
};
void compare_pixels(const TimeFilter::State& state, const AddedFrames& added,
                    const ComparedPixels& compared);

struct WeighedPixels {
  const float* patch_chi2 = nullptr;  ///< sums over rows, with two extra columns at both ends
  const float* counts = nullptr;
  const float* difference = nullptr;
  std::ptrdiff_t difference_stride = 0;
  const float* own_chi2 = nullptr;
  const float* usable = nullptr;
  const float* past = nullptr;
  const float* averaged_now = nullptr;  ///< null: 1
  int pixels = 0;
  float none = 0.0f;           ///< weight of unusable pixels
  float* weight = nullptr;     ///< of the past
  float* unchanged = nullptr;  ///< 1 if no test detects a change
};
void weigh_pixels(const TimeFilter::State& state, const WeighedPixels& weighed);

/// Computes now + (mean - now) w / (w + n), and the number of averaged measurements.
void add_pixels(const float* now, const float* averaged_now, const float* weight, int measurements,
                int pixels, float* mean, std::ptrdiff_t mean_stride, float* averaged);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "decode/filter/time_filter_state.hpp"

namespace tofsmith {

/// Pixels of a row beside what was added to them: [K][TimeFilter::State::block_pixels].
struct ComparedPixels {
  const float* now = nullptr;
  const float* averaged_now = nullptr;
  std::ptrdiff_t first = 0;  ///< of the pixels in the frame
  int pixels = 0;
  float* usable = nullptr;               ///< 1 where both are measurements of light, else 0
  float* difference = nullptr;           ///< in standard deviations; 0 where not usable
  std::ptrdiff_t difference_stride = 0;  ///< from one measurement to the next
  float* chi2 = nullptr;                 ///< as it is where not usable
};
void compare_pixels(const TimeFilter::State& state, const AddedFrames& added,
                    const ComparedPixels& compared);

/// Sums over the rows of a patch, and what the pixels show by themselves.
struct WeighedPixels {
  const float* patch_chi2 = nullptr;  ///< sums over rows; two columns more at both ends
  const float* counts = nullptr;
  const float* difference = nullptr;
  std::ptrdiff_t difference_stride = 0;
  const float* own_chi2 = nullptr;
  const float* usable = nullptr;
  const float* past = nullptr;
  const float* averaged_now = nullptr;  ///< null: 1
  int pixels = 0;
  float none = 0.0f;           ///< the weight of pixels that are not usable
  float* weight = nullptr;     ///< of what was added
  float* unchanged = nullptr;  ///< 1 where no test shows a change, else 0
};
void weigh_pixels(const TimeFilter::State& state, const WeighedPixels& weighed);

/// now + (mean - now) w / (w + n) of each measurement, and of how many that is the mean.
void add_pixels(const float* now, const float* averaged_now, const float* weight, int measurements,
                int pixels, float* mean, std::ptrdiff_t mean_stride, float* averaged);

}  // namespace tofsmith

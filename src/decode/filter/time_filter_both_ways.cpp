// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "decode/filter/time_filter_state.hpp"

namespace tofsmith {

/// Past and future are each compared with the frame. Linear changes cancel if both have the same
/// weight.
void TimeFilter::State::join_row(const RawView& raw, int row) {
  Numbers numbers;
  BlockOfPixels averaged_now;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    const float* const w_past = past.weights.data() + first;
    const float* const w_future = future.weights.data() + first;
    for (int k = 0; k < measurements; ++k) {
      const float* const now = numbers.data() + k * block_pixels;
      const float* const before = mean(past, k, first);
      float* const after = mean(future, k, first);
      for (int i = 0; i < pixels; ++i) {
        // The means of pixels without weight may be NaN.
        const float d_past = w_past[i] > 0.0f ? w_past[i] * (before[i] - now[i]) : 0.0f;
        const float d_future = w_future[i] > 0.0f ? w_future[i] * (after[i] - now[i]) : 0.0f;
        const float both =
            now[i] + (d_past + d_future) / (w_past[i] + w_future[i] + averaged_now.data()[i]);
        after[i] = w_past[i] + w_future[i] > 0.0f ? both : now[i];
      }
    }
    const float* const n_past = past.averaged.pixels.data() + first;
    float* const n_future = future.averaged.pixels.data() + first;
    for (int i = 0; i < pixels; ++i) {
      const float p = w_past[i], f = w_future[i], n = averaged_now.data()[i];
      const float squares =
          (p > 0.0f ? p * p / n_past[i] : 0.0f) + (f > 0.0f ? f * f / n_future[i] : 0.0f);
      n_future[i] = p + f > 0.0f ? (p + f + n) * (p + f + n) / (squares + n) : n;
    }
  }
}

void TimeFilter::State::join(const RawView& raw) {
  for (AddedFrames* const side : {&past, &future}) {
    if (side->is_empty)
      std::fill(side->weights.begin(), side->weights.end(), 0.0f);
    else
      weigh(raw, *side);
  }
  for_each_row([&](int row) { join_row(raw, row); });
}

RawView TimeFilter::State::finish_oldest() {
  future.is_empty = true;
  for (int i = waiting.count() - 1; i > 0; --i) {
    const RawView later = waiting.view(i);
    if (!future.is_empty) weigh(later, future);
    add(later, future);
  }
  const RawView oldest = waiting.view(0);
  join(oldest);
  add(oldest, past);
  waiting.pop();
  return view(future);
}

std::size_t WaitingFrames::slot(int index) const {
  return (first_ + static_cast<std::size_t>(index)) % slots_.size();
}

void WaitingFrames::push(const RawView& raw) {
  if (count_ == static_cast<int>(slots_.size())) {
    std::rotate(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(first_), slots_.end());
    first_ = 0;
    slots_.emplace_back();
  }
  height_ = raw.height;
  width_ = raw.width;
  measurements_ = raw.measurements;
  Slot& last = slots_[slot(count_)];
  const auto pixels = static_cast<std::size_t>(raw.pixels());
  last.values.resize(pixels * static_cast<std::size_t>(measurements_));
  copy_pixels(raw, 0, raw.pixels(), last.values.data());
  if (raw.averaged)
    last.averaged.assign(raw.averaged, raw.averaged + pixels);
  else
    last.averaged.clear();
  ++count_;
}

RawView WaitingFrames::view(int index) const {
  const Slot& at = slots_[slot(index)];
  RawView view = RawView::interleaved(at.values.data(), height_, width_, measurements_);
  if (!at.averaged.empty()) view.averaged = at.averaged.data();
  return view;
}

void WaitingFrames::pop() {
  first_ = slot(1);
  --count_;
}

}  // namespace tofsmith

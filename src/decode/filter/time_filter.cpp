// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "decode/filter/shared/filter_parts.hpp"
#include "decode/filter/time_filter_state.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

void TimeFilterOptions::validate() const { check_fields(*this, "TimeFilterOptions::"); }

TimeFilter::TimeFilter(const DecodingTable& table, const TimeFilterOptions& options) {
  options.validate();
  table.validate();
  require_exposures(table, "the temporal filter");
  state_ = make_hidden<State>(table, options, AmbientProjection(table));
}

const TimeFilter::State& state_of(const TimeFilter& filter) { return *filter.state_; }

const DecodingTable& TimeFilter::table() const { return state_->table; }
const TimeFilterOptions& TimeFilter::options() const { return state_->options; }

std::size_t TimeFilter::memory_bytes(const TimeFilterOptions& options, int height, int width,
                                     int measurements, int threads) {
  const auto strips = static_cast<std::size_t>(
      std::min(threads, (height + compared_strip_rows - 1) / compared_strip_rows));
  const auto pixels = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  const auto k_count = static_cast<std::size_t>(measurements);
  const auto ahead = static_cast<std::size_t>(options.look_ahead);
  const std::size_t frames =
      (ahead > 0 ? 2 * (k_count + 2) + (ahead + 1) * (k_count + 1) : k_count + 2) +
      (options.before_filter ? 1 : 0);
  return sizeof(float) * (pixels * frames + State::cell_floats(height, width, measurements) +
                          strips * ComparedRows::floats(compared_strip_rows + 2 * patch_reach,
                                                        width, measurements));
}

std::optional<RawView> TimeFilter::add(const RawView& stored) {
  State& state = *state_;
  const MarkedRaw marked(stored, state.table.marking);
  const RawView& raw = marked.view();
  require_measurements(raw, state.measurements);
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  if (state.is_empty()) {
    state.resize(raw);
  } else {
    require(raw.height == state.height, "raw height", raw.height,
            "must equal that of the previous frames, " + std::to_string(state.height));
    require(raw.width == state.width, "raw width", raw.width,
            "must equal that of the previous frames, " + std::to_string(state.width));
  }
  if (state.options.look_ahead > 0) {
    state.waiting.push(raw);
    if (state.waiting.count() <= state.options.look_ahead) return std::nullopt;
    return state.finish_oldest();
  }
  if (!state.past.is_empty) state.weigh(raw, state.past);
  state.add(raw, state.past);
  return state.view(state.past);
}

std::optional<RawView> TimeFilter::add_end() {
  if (state_->waiting.count() > 0) return state_->finish_oldest();
  forget();
  return std::nullopt;
}

void TimeFilter::forget() {
  state_->past.is_empty = true;
  state_->waiting.clear();
}

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

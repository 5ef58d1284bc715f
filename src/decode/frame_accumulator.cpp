// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/shared/frame_accumulator.hpp"

#include <algorithm>

#include "core/shared/pixel_runs.hpp"
#include "core/shared/working_threads.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

void MeanOfRows::start(const RawView& first) {
  height_ = first.height;
  width_ = first.width;
  measurements_ = first.measurements;
  sums_.assign(static_cast<std::size_t>(first.pixels()) * static_cast<std::size_t>(measurements_),
               0.0);
}

void MeanOfRows::add(const RawView& raw) {
  if (is_empty()) start(raw);
  parallel_for(height_, [&](std::int64_t row) {
    const std::int64_t first = row * width_;
    for_each_run(raw, first, width_, [&](const auto* pixel, std::int64_t length, std::int64_t) {
      double* sum = sums_.data() + first * measurements_;
      for (std::int64_t x = 0; x < length; ++x, pixel += raw.column_stride)
        for (int k = 0; k < measurements_; ++k, ++sum)
          *sum = levels_.added(*sum, static_cast<double>(pixel[k * raw.measurement_stride]));
    });
  });
  ++frames_;
}

RawView MeanOfRows::finish(double averaged) {
  for (double& sum : sums_) sum = levels_.mean(sum, frames_);
  averaged_.assign(static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_),
                   static_cast<float>(averaged * frames_));
  frames_ = 0;
  RawView view = RawView::interleaved(sums_.data(), height_, width_, measurements_);
  view.averaged = averaged_.data();
  view.is_marked = true;
  return view;
}

FrameAccumulator::FrameAccumulator(const DecodingTable& table, const FrameSteps& steps)
    : steps_(steps), measurements_(table.measurements()), mean_(SaturationLevels(table)) {
  if (steps.time_filter) time_filter_.emplace(table, *steps.time_filter);
}

FrameMemory FrameAccumulator::memory(int recorded, int height, int width) const {
  FrameMemory memory;
  if (steps_.average > 1)
    memory.row = static_cast<double>(width) *
                 (static_cast<double>(sizeof(double)) * measurements_ + sizeof(float));
  if (steps_.time_filter) {
    TimeFilterOptions options = *steps_.time_filter;  // waiting frames are limited by the recording
    const int means = (recorded + steps_.average - 1) / steps_.average;
    options.look_ahead = std::min(options.look_ahead, means - 1);
    memory.whole = static_cast<double>(
        TimeFilter::memory_bytes(options, height, width, measurements_, working_threads()));
  }
  return memory;
}

std::optional<RawView> FrameAccumulator::filtered(const RawView& frame) {
  return time_filter_ ? time_filter_->add(frame) : std::optional(frame);
}

std::optional<RawView> FrameAccumulator::submit(const RawView& raw, bool completes_mean) {
  if (steps_.average == 1) return filtered(raw);
  mean_.add(raw);
  return completes_mean ? filtered(mean_.finish(steps_.averaged)) : std::nullopt;
}

std::optional<RawView> FrameAccumulator::submit_end() {
  if (!mean_.is_empty()) return filtered(mean_.finish(steps_.averaged));
  return time_filter_ ? time_filter_->add_end() : std::nullopt;
}

}  // namespace tofsmith

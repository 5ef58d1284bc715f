// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/sliding_window.hpp"

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/shared/pixel_runs.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

template <typename Number>
void copy_measurements(const RawView& frame, int first, int count, std::vector<Number>& numbers) {
  const std::int64_t measurements = frame.measurements;
  numbers.resize(static_cast<std::size_t>(frame.pixels() * measurements));
  parallel_for(frame.height, [&](std::int64_t row) {
    Number* to = numbers.data() + row * frame.width * measurements;
    for_each_run(frame, row * frame.width, frame.width,
                 [&](const auto* pixel, std::int64_t length, std::int64_t) {
                   for (std::int64_t i = 0; i < length;
                        ++i, pixel += frame.column_stride, to += measurements)
                     for (int k = first; k < first + count; ++k)
                       to[k] = static_cast<Number>(pixel[k * frame.measurement_stride]);
                 });
  });
}

}  // namespace

void SlidingWindow::take(const RawView& frame, int exposure) {
  const int count = frame.measurements / exposures_;
  std::visit(
      [&](const auto* data) {
        using Numbers = std::vector<std::remove_cvref_t<decltype(*data)>>;
        if (!std::holds_alternative<Numbers>(numbers_)) numbers_ = Numbers();
        copy_measurements(frame, exposure * count, count, std::get<Numbers>(numbers_));
      },
      frame.data);
  newest_ = frame;
}

RawView SlidingWindow::view() const {
  RawView view = std::visit(
      [&](const auto& numbers) {
        return RawView::interleaved(numbers.data(), newest_.height, newest_.width,
                                    newest_.measurements);
      },
      numbers_);
  view.was_unsigned = newest_.was_unsigned;
  view.is_marked = newest_.is_marked;
  return view;
}

}  // namespace tofsmith

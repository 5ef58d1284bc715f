// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/prepared_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "core/shared/pixel_runs.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

std::vector<Band> bands_of(int first, int last, int height, int rows) {
  std::vector<Band> bands;
  for (int frame = first; frame < last; ++frame)
    for (int row = 0; row < height; row += rows)
      bands.push_back({frame, row, std::min(rows, height - row)});
  return bands;
}

ReadAhead::ReadAhead(const RawFramesReader& reader, std::vector<Band> bands)
    : reader_(reader), bands_(std::move(bands)) {
  start();
}

void ReadAhead::start() {
  if (started_ == bands_.size()) return;
  const Band band = bands_[started_];
  std::vector<std::byte>& buffer = buffers_[started_ % 2];
  ++started_;
  coming_ = std::async(std::launch::async, [this, band, &buffer] {
    return reader_.read_rows(band.frame, band.first_row, band.rows, buffer);
  });
}

std::optional<RawView> ReadAhead::next() {
  if (!coming_.valid()) return std::nullopt;
  const RawView view = coming_.get();
  start();
  return view;
}

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

namespace {

/// A temporal filter needs all windows up to the last.
std::vector<Band> bands_of_windows(const Preparation& preparation,
                                   const std::vector<Band>& windows) {
  if (windows.empty()) return {};
  const int exposures = preparation.sliding, rows = windows.front().rows,
            first = preparation.steps.time_filter ? 0 : windows.front().frame,
            last_exposure = windows.back().frame + exposures - 1;
  return bands_of(first / exposures, last_exposure / exposures + 1, rows, rows);
}

int frames_of_mean(const Preparation& preparation, int recorded, int index) {
  return std::min(preparation.group(), recorded - index * preparation.group());
}

RawFrames copy_of(const RawView& raw) {
  RawFrames copy{1, raw.height, raw.width, raw.measurements, {}};
  copy.values.resize(static_cast<std::size_t>(raw.pixels()) *
                     static_cast<std::size_t>(raw.measurements));
  copy_pixels(raw, 0, raw.pixels(), copy.values.data());
  return copy;
}

}  // namespace

std::vector<Band> bands_to_read(const Preparation& preparation, int recorded,
                                const std::vector<Band>& bands) {
  if (preparation.sliding > 0) return bands_of_windows(preparation, bands);
  std::vector<Band> needed;
  const std::optional<TimeFilterOptions>& time_filter = preparation.steps.time_filter;
  if (time_filter && !bands.empty()) {
    const int last =
        std::min(preparation.frames_of(recorded), bands.back().frame + 1 + time_filter->look_ahead);
    needed = bands_of(0, last, bands.front().rows, bands.front().rows);
  } else {
    needed = bands;
  }
  std::vector<Band> all;
  for (const Band& band : needed)
    for (int i = 0; i < frames_of_mean(preparation, recorded, band.frame); ++i)
      all.push_back({band.frame * preparation.group() + i, band.first_row, band.rows});
  return all;
}

FrameMemory Preparation::memory(int height, int width, int measurements) const {
  // Per pixel, while mixed pixels are marked.
  constexpr double bytes_to_find_mixed = 4 * sizeof(float) + 3;
  constexpr auto bytes = static_cast<double>(sizeof(float));
  FrameMemory memory;
  if (find_mixed) memory.whole += bytes_to_find_mixed * height * width;
  if (!stray_kernel.empty()) {
    memory.whole += StrayLight(stray_kernel).memory_bytes(height, width, measurements);
    memory.row += bytes * width * measurements;
  }
  if (!hdr.empty())
    memory.row += width * bytes * ((group() + 1.0) * measurements + 2.0);
  else if (steps.average == 1 && steps.averaged != 1.0)
    memory.row += bytes * width;
  if (sliding > 0) memory.row += static_cast<double>(sizeof(double)) * width * measurements;
  return memory;
}

std::vector<std::unique_ptr<FramePipeline>> prepare_pipelines(const FrameBackend& backend,
                                                              const Preparation& preparation,
                                                              int height, int width) {
  std::vector<std::unique_ptr<FramePipeline>> pipelines;
  for (int i = 0; i < preparation.pipelines(); ++i)
    pipelines.push_back(backend.prepare(preparation.steps, height, width));
  return pipelines;
}

PreparedFrames::PreparedFrames(Input input, const Preparation& preparation,
                               const std::vector<std::unique_ptr<FramePipeline>>& pipelines,
                               int recorded)
    : preparation_(preparation),
      pipelines_(pipelines),
      recorded_(recorded),
      input_(std::move(input)) {
  if (!preparation.stray_kernel.empty()) stray_light_.emplace(preparation.stray_kernel);
}

std::optional<RawView> PreparedFrames::read() {
  std::optional<RawView> raw = input_();
  if (raw && stray_light_) {
    stray_light_->remove(*raw, pipeline().table(), clean_);
    raw = RawView::interleaved(clean_.values.data(), raw->height, raw->width, raw->measurements);
    raw->is_marked = true;
  }
  if (!raw || preparation_.steps.averaged == 1.0) return raw;
  averaged_.assign(static_cast<std::size_t>(raw->pixels()),
                   static_cast<float>(preparation_.steps.averaged));
  raw->averaged = averaged_.data();
  return raw;
}

std::optional<RawView> PreparedFrames::bracketed(const Progress& progress) {
  const std::size_t frames = preparation_.hdr.size();
  exposed_.resize(frames);
  std::vector<RawView> views;
  for (std::size_t i = 0; i < frames; ++i) {
    report(progress, static_cast<double>(i) / static_cast<double>(frames), "merging exposures");
    const std::optional<RawView> raw = read();
    if (!raw) break;
    exposed_[i] = copy_of(*raw);
    views.push_back(RawView::interleaved(exposed_[i].values.data(), raw->height, raw->width,
                                         raw->measurements));
    views.back().averaged = raw->averaged;
    views.back().is_marked = raw->is_marked;
  }
  if (views.empty()) return std::nullopt;
  if (views.size() < frames)  // of a stream: recordings hold whole groups
    throw IoError(
        "the stream",
        fmt::format("found {} frame{} and the end; expected {}, one for each exposure of --hdr",
                    views.size(), views.size() == 1 ? "" : "s", frames));
  merge_exposures(views, preparation_.hdr, pipeline().table(), merged_);
  return merged_.view();
}

/// Returns none after the last. `index` must follow the last call.
std::optional<RawView> PreparedFrames::window(int index) {
  const int exposures = preparation_.sliding;
  int missing = window_ ? 1 : exposures + index % exposures;
  if (!window_) window_.emplace(exposures);
  for (; missing > 0; --missing) {
    const bool is_first = next_exposure_ == 0;
    if (is_first || preparation_.exposures_arrive) newest_ = read();
    if (!newest_) return std::nullopt;
    window_->take(*newest_, next_exposure_);
    next_exposure_ = (next_exposure_ + 1) % exposures;
  }
  return window_->view();
}

/// Returns whether a frame is ready; none after the last.
std::optional<bool> PreparedFrames::submit_group(int frame, const Progress& progress) {
  if (!preparation_.hdr.empty()) {
    const std::optional<RawView> merged = bracketed(progress);
    return merged ? std::optional(pipeline().submit(*merged)) : std::nullopt;
  }
  if (preparation_.sliding > 0) {
    const std::optional<RawView> raw = window(frame);
    return raw ? std::optional(pipeline().submit(*raw)) : std::nullopt;
  }
  const int frames = frames_of_mean(preparation_, recorded_, frame);
  bool is_ready = false;
  for (int i = 0; i < frames; ++i) {
    if (preparation_.steps.average > 1)
      report(progress, static_cast<double>(i) / frames, "averaging");
    const std::optional<RawView> raw = read();
    if (!raw && i == 0) return std::nullopt;
    if (!raw) return pipeline().submit_end();
    is_ready = pipeline().submit(*raw, i + 1 == frames);
  }
  return frames > 0 ? std::optional(is_ready) : std::nullopt;
}

/// The temporal filter may need later frames, and earlier ones that are not decoded.
bool PreparedFrames::next_in_time(int frame, const Progress& progress) {
  const int ahead = preparation_.steps.time_filter->look_ahead;
  const int coming = std::min(ahead, std::max(recorded_ - 1 - frame, 0)) + frame + 1 - frames_read_;
  const auto steps = static_cast<std::size_t>(std::max(coming, 1));
  const ProgressParts parts(progress, steps);
  for (std::size_t step = 0; frames_ready_ <= frame; ++step) {
    const Progress here = parts[std::min(step, steps - 1)];
    current_ = static_cast<std::size_t>(frames_read_) % pipelines_.size();
    std::optional<bool> is_ready;
    if (!has_ended_) is_ready = submit_group(frames_read_, here);
    if (is_ready) {
      ++frames_read_;
    } else {
      has_ended_ = true;
      is_ready = pipeline().submit_end();
      if (!*is_ready) return false;
    }
    if (*is_ready) ++frames_ready_;
    report(here, 1.0, "filtering");
  }
  return true;
}

bool PreparedFrames::next(int frame, const Progress& progress) {
  if (preparation_.steps.time_filter) return next_in_time(frame, progress);
  return submit_group(frame, progress).value_or(false);
}

}  // namespace tofsmith

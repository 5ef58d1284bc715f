// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/prepared_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/shared/pixel_runs.hpp"
#include "core/shared/working_threads.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// Frames of the recording that frame `index` of what comes out is made of.
int frames_of_mean(const Preparation& preparation, int recorded, int index) {
  return std::min(preparation.group(), recorded - index * preparation.group());
}

RawFrames copy_of(const RawView& raw) {
  RawFrames copy{.frames = 1,
                 .height = raw.height,
                 .width = raw.width,
                 .measurements = raw.measurements,
                 .values = {}};
  copy.values.reserve(static_cast<std::size_t>(raw.pixels()) *
                      static_cast<std::size_t>(raw.measurements));
  for_each_run(raw, 0, raw.pixels(), [&](const auto* pixel, std::int64_t length, std::int64_t) {
    for (std::int64_t x = 0; x < length; ++x, pixel += raw.column_stride)
      for (int k = 0; k < raw.measurements; ++k)
        copy.values.push_back(static_cast<float>(pixel[k * raw.measurement_stride]));
  });
  return copy;
}

}  // namespace

std::vector<Band> bands_to_read(const Preparation& preparation, int recorded,
                                const std::vector<Band>& bands) {
  std::vector<Band> needed;
  if (preparation.time_filter && !bands.empty()) {
    // Whole frames: all up to the last, and those that it looks ahead to.
    const int last = std::min(preparation.frames_of(recorded),
                              bands.back().frame + 1 + preparation.time_filter->look_ahead);
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

double Preparation::frame_bytes(int recorded, int height, int width, int measurements) const {
  // What is known of the pixels while mixed ones are marked.
  constexpr double bytes_to_find_mixed = 4 * sizeof(float) + 3;
  const int threads = working_threads();
  std::size_t bytes = 0;
  const bool is_there = is_elsewhere(std::int64_t{height} * width);
  if (time_filter && !is_there) {
    TimeFilterOptions within = *time_filter;  // never more frames wait than there are
    within.look_ahead = std::min(within.look_ahead, frames_of(recorded) - 1);
    bytes += TimeFilter::memory_bytes(within, height, width, measurements, threads);
  }
  if (time_filter && is_there && wants_numbers)
    bytes += sizeof(float) * static_cast<std::size_t>(height) * static_cast<std::size_t>(width) *
             static_cast<std::size_t>(measurements + 1);
  if (filter) bytes += Filter::memory_bytes(*filter, height, width, measurements, threads);
  if (!stray_kernel.empty())
    bytes += static_cast<std::size_t>(
        StrayLight(stray_kernel).memory_bytes(height, width, measurements));
  const double for_mixed = find_mixed ? bytes_to_find_mixed * height * width : 0.0;
  return for_mixed + static_cast<double>(bytes);
}

double Preparation::row_bytes(int width, int measurements) const {
  const double clean = stray_kernel.empty() ? 0.0 : 1.0 * sizeof(float) * width * measurements;
  return clean + row_bytes_of_sums(width, measurements);
}

double Preparation::row_bytes_of_sums(int width, int measurements) const {
  if (!hdr.empty())
    return static_cast<double>(width) * static_cast<double>(sizeof(float)) *
           ((group() + 1.0) * measurements + 2.0);
  if (average == 1) return averaged == 1.0 ? 0.0 : static_cast<double>(sizeof(float)) * width;
  return static_cast<double>(width) *
         (static_cast<double>(sizeof(double)) * measurements + sizeof(float));
}

void RowSums::start(const RawView& first, const SaturationLevels& levels) {
  height_ = first.height;
  width_ = first.width;
  measurements_ = first.measurements;
  frames_ = 0;
  levels_ = levels;
  sums_.assign(static_cast<std::size_t>(first.pixels()) * static_cast<std::size_t>(measurements_),
               0.0);
}

void RowSums::add(const RawView& raw) {
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

RawView RowSums::means(double averaged) {
  for (double& sum : sums_) sum = levels_.mean(sum, frames_);
  averaged_.assign(static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_),
                   static_cast<float>(averaged * frames_));
  RawView view = RawView::interleaved(sums_.data(), height_, width_, measurements_);
  view.averaged = averaged_.data();
  view.is_marked = true;
  return view;
}

PreparedFrames::PreparedFrames(Input input, const DecodingTable& table,
                               const Preparation& preparation, int recorded)
    : table_(table), preparation_(preparation), recorded_(recorded), input_(std::move(input)) {
  if (preparation.time_filter) time_filter_.emplace(table, *preparation.time_filter);
  if (preparation.filter && !preparation.filters_with_decoder)
    filter_.emplace(table, *preparation.filter);
  if (!preparation.stray_kernel.empty()) stray_light_.emplace(preparation.stray_kernel);
}

/// As it is in the recording.
std::optional<RawView> PreparedFrames::read() {
  std::optional<RawView> raw = input_();
  if (raw && stray_light_) {
    stray_light_->remove(*raw, table_, clean_);
    raw = RawView::interleaved(clean_.values.data(), raw->height, raw->width, raw->measurements);
    raw->is_marked = true;
  }
  if (!raw || preparation_.averaged == 1.0) return raw;
  averaged_.assign(static_cast<std::size_t>(raw->pixels()),
                   static_cast<float>(preparation_.averaged));
  raw->averaged = averaged_.data();
  return raw;
}

/// The next frames of all exposures as one.
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
    throw IoError("the stream",
                  fmt::format("found {} frame{} and the end; expected {}, one of each "
                              "exposure of --hdr",
                              views.size(), views.size() == 1 ? "" : "s", frames));
  merge_exposures(views, preparation_.hdr, table_, merged_);
  return merged_.view();
}

/// A band of frame `frame` as it is read or, of several, as their mean; of one that is made
/// elsewhere, its size.
std::optional<RawView> PreparedFrames::measured(int frame, const Progress& progress) {
  if (!preparation_.hdr.empty()) return bracketed(progress);
  if (preparation_.average == 1) return read();
  const int frames = frames_of_mean(preparation_, recorded_, frame);
  if (frames <= 0) return std::nullopt;  // after the last
  RawView last;
  for (int i = 0; i < frames; ++i) {
    report(progress, static_cast<double>(i) / frames, "averaging");
    std::optional<RawView> raw = read();
    if (!raw && i == 0) return std::nullopt;
    if (!raw) break;
    last = *raw;
    if (is_elsewhere(last)) {
      preparation_.elsewhere.add(last);
      continue;
    }
    if (i == 0) sums_.start(last, SaturationLevels(table_));
    sums_.add(last);
  }
  if (!is_elsewhere(last)) return sums_.means(preparation_.averaged);
  preparation_.elsewhere.take_mean(preparation_.averaged);
  return last;
}

/// All frames of a recording are, or none.
bool PreparedFrames::is_elsewhere(const RawView& raw) {
  if (!is_elsewhere_) is_elsewhere_ = preparation_.is_elsewhere(raw.pixels());
  return *is_elsewhere_;
}

/// The numbers that came of it, or none, where nobody reads them here.
RawView PreparedFrames::frame_elsewhere(const RawView& raw) const {
  if (preparation_.wants_numbers) return preparation_.elsewhere.numbers();
  return RawView::interleaved(static_cast<const float*>(nullptr), raw.height, raw.width,
                              raw.measurements);
}

/// What comes of the next frame or, after the last, of those that wait.
RawView PreparedFrames::added_elsewhere(const RawView& raw) {
  frame_size_ = RawView::interleaved(static_cast<const float*>(nullptr), raw.height, raw.width,
                                     raw.measurements);
  if (preparation_.average == 1) preparation_.elsewhere.take(raw);  // means were made there
  return frame_elsewhere(frame_size_);
}

/// Frame `frame` with what is the same in those around it.
std::optional<RawView> PreparedFrames::added_up(int frame, const Progress& progress) {
  const int ahead = preparation_.time_filter->look_ahead;
  const int coming = std::min(ahead, recorded_ - 1 - frame) + frame + 1 - frames_read_;
  const auto steps = static_cast<std::size_t>(std::max(coming, 1));
  const ProgressParts parts(progress, steps);
  std::optional<RawView> added;
  for (std::size_t step = 0; frames_added_ <= frame; ++step) {
    const Progress here = parts[std::min(step, steps - 1)];
    const std::optional<RawView> raw = has_ended_ ? std::nullopt : measured(frames_read_, here);
    if (raw)
      ++frames_read_;
    else
      has_ended_ = true;
    if (is_elsewhere_.value_or(raw && is_elsewhere(*raw)))
      added = raw ? std::optional(added_elsewhere(*raw)) : std::nullopt;
    else
      added = raw ? time_filter_->add(*raw) : time_filter_->add_end();
    if (!added && has_ended_) break;
    if (added) ++frames_added_;
    report(here, 1.0, "filtering");
  }
  return added;
}

std::optional<RawView> PreparedFrames::next(int frame, const Progress& progress) {
  if (time_filter_) return added_up(frame, progress);
  const std::optional<RawView> raw = measured(frame, progress);
  return raw && is_elsewhere(*raw) ? frame_elsewhere(*raw) : raw;
}

void PreparedFrames::decode(
    const RawView& raw, const PixelStatus* statuses,
    const std::function<void(const RawView&, const UnfilteredPixels&, const Progress&)>& decode,
    const Progress& progress) {
  if (filter_)
    decode_filtered(*filter_, raw, filtered_, decode, statuses, progress);
  else
    decode(raw, {}, progress);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/prepared_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "core/shared/pixel_runs.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// Frames of the recording that frame `index` of what comes out is made of.
int frames_of_mean(const Preparation& preparation, int recorded, int index) {
  return std::min(preparation.average, recorded - index * preparation.average);
}

/// Bands to read for those that come out.
std::vector<Band> bands_to_read(const Preparation& preparation, int recorded,
                                const std::vector<Band>& bands) {
  std::vector<Band> all;
  for (const Band& band : bands)
    for (int i = 0; i < frames_of_mean(preparation, recorded, band.frame); ++i)
      all.push_back({band.frame * preparation.average + i, band.first_row, band.rows});
  return all;
}

/// A table whose raw numbers are means of so many frames: their electrons are those of one exposure
/// that is so many times longer, read so many times.
DecodingTable table_of_means(DecodingTable table, int frames) {
  table.exposure_s *= frames;
  table.dark_electrons *= frames;
  table.shot_dark_electrons *= frames;
  table.constant_variance_e2 *= frames;
  table.gain_e_per_raw *= frames;
  return table;
}

double added(double sum, double value, double clipped) {
  if (!std::isfinite(value) || std::isnan(sum)) return std::numeric_limits<double>::quiet_NaN();
  return value >= clipped ? std::numeric_limits<double>::infinity() : sum + value;
}

}  // namespace

double Preparation::frame_bytes(int height, int width, int measurements) const {
  // What is known of the pixels while mixed ones are marked.
  constexpr double bytes_to_find_mixed = 2 * sizeof(float) + 2;
  const double for_mixed = find_mixed ? bytes_to_find_mixed * height * width : 0.0;
  if (!filter) return for_mixed;
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const double means = average > 1 ? sizeof(float) * static_cast<double>(height) * width : 0.0;
  return for_mixed + means +
         static_cast<double>(Filter::memory_bytes(*filter, height, width, measurements, threads));
}

double Preparation::row_bytes(int width, int measurements) const {
  if (average == 1) return 0.0;
  return static_cast<double>(width) *
         (static_cast<double>(sizeof(double)) * measurements + sizeof(float));
}

void RowSums::start(const RawView& first, std::optional<float> saturation_level) {
  height_ = first.height;
  width_ = first.width;
  measurements_ = first.measurements;
  frames_ = 0;
  saturation_level_ = saturation_level;
  sums_.assign(static_cast<std::size_t>(first.pixels()) * static_cast<std::size_t>(measurements_),
               0.0);
}

void RowSums::add(const RawView& raw) {
  const double clipped = saturation_level_ ? static_cast<double>(*saturation_level_)
                                           : std::numeric_limits<double>::infinity();
  parallel_for(height_, [&](std::int64_t row) {
    const std::int64_t first = row * width_;
    for_each_run(raw, first, width_, [&](const auto* pixel, std::int64_t length, std::int64_t) {
      double* sum = sums_.data() + first * measurements_;
      for (std::int64_t x = 0; x < length; ++x, pixel += raw.column_stride)
        for (int k = 0; k < measurements_; ++k, ++sum)
          *sum = added(*sum, static_cast<double>(pixel[k * raw.measurement_stride]), clipped);
    });
  });
  ++frames_;
}

RawView RowSums::means() {
  const double level = saturation_level_.value_or(std::numeric_limits<float>::infinity());
  for (double& sum : sums_) sum = std::isinf(sum) ? level : sum / frames_;
  averaged_.assign(static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_),
                   static_cast<float>(frames_));
  RawView view = RawView::interleaved(sums_.data(), height_, width_, measurements_);
  view.averaged = averaged_.data();
  return view;
}

PreparedFrames::PreparedFrames(const RawFramesReader& reader, const DecodingTable& table,
                               const Preparation& preparation, std::vector<Band> bands)
    : table_(table),
      preparation_(preparation),
      recorded_(reader.frames()),
      bands_(std::move(bands)),
      input_(reader, bands_to_read(preparation, recorded_, bands_)) {}

RawView PreparedFrames::next_mean(const Progress& progress) {
  const int frames = frames_of_mean(preparation_, recorded_, bands_[next_].frame);
  for (int i = 0; i < frames; ++i) {
    report(progress, static_cast<double>(i) / frames, "averaging");
    const RawView raw = input_.next();
    if (i == 0) sums_.start(raw, table_.saturation_level);
    sums_.add(raw);
  }
  return sums_.means();
}

RawView PreparedFrames::filtered(const RawView& mean, int frames, const Progress& progress) {
  auto filter = filters_.find(frames);
  if (filter == filters_.end())
    filter = filters_.emplace(frames, Filter(table_of_means(table_, frames), *preparation_.filter))
                 .first;
  RawView raw = mean;
  raw.averaged = nullptr;  // the filter's table knows
  filter->second.apply(raw, filtered_, progress);
  RawView view = filtered_.view();
  if (frames == 1) return view;
  averaged_ = filtered_.averaged();
  for (float& n : averaged_.pixels) n *= static_cast<float>(frames);
  view.averaged = averaged_.pixels.data();
  return view;
}

RawView PreparedFrames::next(const Progress& progress) {
  const bool is_mean = preparation_.average > 1;
  const ProgressParts parts(progress, {1.0, preparation_.filter ? 8.0 : 0.0});
  const int frames = frames_of_mean(preparation_, recorded_, bands_[next_].frame);
  RawView raw = is_mean ? next_mean(parts[0]) : input_.next();
  if (preparation_.filter) raw = filtered(raw, frames, parts[1]);
  ++next_;
  return raw;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/frame_pipeline.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "core/shared/pixel_runs.hpp"
#include "core/shared/working_threads.hpp"
#include "decode/shared/frame_accumulator.hpp"
#include "decode/shared/marked_raw.hpp"
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
  return marked_view(RawView::interleaved(sums_.data(), height_, width_, measurements_),
                     averaged_.data());
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

namespace {

class CpuPipeline final : public FramePipeline {
 public:
  CpuPipeline(const DepthDecoder& decoder, const FrameSteps& frame_steps, int height, int width)
      : FramePipeline(decoder, frame_steps, height, width),
        accumulator_(decoder.table(), frame_steps) {}

  FrameMemory memory(int recorded) const override {
    FrameMemory memory = accumulator_.memory(recorded, height(), width());
    if (const Filter* filter = steps().filter)
      memory.whole += static_cast<double>(Filter::memory_bytes(
          filter->options(), height(), width(), filter->measurements(), working_threads()));
    return memory;
  }

  bool submit(const RawView& raw, bool completes_mean) override {
    is_filtered_ = false;
    ready_ = accumulator_.submit(raw, completes_mean);
    return ready_.has_value();
  }
  bool submit_end() override {
    is_filtered_ = false;
    ready_ = accumulator_.submit_end();
    return ready_.has_value();
  }

  void decode(const DecodedView& decoded, const Progress& progress,
              const Image<std::uint8_t>& left_out) override {
    if (!steps().filter) return decoder().decode(measured(), decoded, progress);
    constexpr double effort = 8.0;  // relative to decoding, roughly
    const ProgressParts parts(progress, {effort, 1.0});
    filter_frame(parts[0], left_out);
    decoder().decode(filtered_.view(), decoded, parts[1]);
  }
  RawView measured() override { return ready_.value(); }
  RawView numbers(const Progress& progress) override {
    if (!steps().filter) return measured();
    if (!is_filtered_) filter_frame(progress, {});
    return filtered_.view();
  }
  const Image<float>& deviation_factor() const override { return filtered_.deviation_factor(); }

 private:
  void filter_frame(const Progress& progress, const Image<std::uint8_t>& left_out) {
    steps().filter->apply(measured(), filtered_, progress, left_out);
    is_filtered_ = true;
  }

  FrameAccumulator accumulator_;
  std::optional<RawView> ready_;
  FilteredFrame filtered_;
  bool is_filtered_ = false;
};

class CpuBackend final : public FrameBackend {
 public:
  explicit CpuBackend(std::unique_ptr<const DepthDecoder> decoder) : decoder_(std::move(decoder)) {}

  const DepthDecoder& decoder() const override { return *decoder_; }
  std::string device() const override { return "cpu"; }
  std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                         int width) const override {
    return std::make_unique<CpuPipeline>(*decoder_, steps, height, width);
  }

 private:
  std::unique_ptr<const DepthDecoder> decoder_;
};

void keep_averaged(const RawView& raw, float* averaged) {
  if (raw.averaged)
    std::copy_n(raw.averaged, raw.pixels(), averaged);
  else
    std::fill_n(averaged, raw.pixels(), 1.0f);
}

/// Adds the planes of `needed` that `decoded` lacks.
/// @return memory of the added planes
DepthImage add_missing_planes(const std::vector<DecodedPlane>& needed, std::size_t pixels,
                              DecodedView& decoded) {
  const std::vector<DecodedPlane> wanted = decoded.planes();
  std::vector<DecodedPlane> missing;
  std::set_difference(needed.begin(), needed.end(), wanted.begin(), wanted.end(),
                      std::back_inserter(missing));
  DepthImage image(missing, 1, static_cast<int>(pixels));
  for_each_plane(
      [](auto*& plane, auto& added) {
        if (!added.empty()) plane = added.pixels.data();
      },
      decoded, image);
  return image;
}

void decode_once(FramePipeline& pipeline, const PlaneCorrections& corrections, std::size_t first,
                 std::size_t pixels, const DecodedView& wanted, const UnfilteredPixels& unfiltered,
                 const Progress& progress) {
  DecodedView decoded = wanted;
  decoded.averaged = nullptr;  // written below
  const auto& limits = corrections.limits;
  const ProgressParts parts(progress, {1.0, limits ? 1.0 : 0.0});
  pipeline.decode(decoded, parts[0], unfiltered.mixed);
  if (limits)
    restrict_depths(*limits, pipeline.decoder(), pipeline.numbers(), corrections.maps,
                    pipeline.width(), first, decoded, parts[1]);
  const DecodingTable& table = pipeline.table();
  if (table.correction)
    apply(*table.correction, table.range_m, decoded, pipeline.height(), pipeline.width(), first,
          pixels);
  apply(corrections.maps, table.range_m, decoded, first, pixels);
  if (limits) remove_outside(*limits, decoded, pixels);
  if (corrections.mixed)
    mark_mixed_pixels(table, pipeline.numbers(), *corrections.mixed, decoded, corrections.maps, {},
                      unfiltered);
  const Image<float>& factor = pipeline.deviation_factor();
  if (decoded.deviation_m && !factor.empty())
    std::transform(decoded.deviation_m, decoded.deviation_m + pixels, &factor.pixels[first],
                   decoded.deviation_m, std::multiplies<>());
  if (wanted.averaged) keep_averaged(pipeline.numbers(), wanted.averaged);
}

}  // namespace

std::unique_ptr<FrameBackend> cpu_backend(std::unique_ptr<const DepthDecoder> decoder) {
  return std::make_unique<CpuBackend>(std::move(decoder));
}

std::vector<DecodedPlane> planes_for(const PlaneCorrections& corrections,
                                     const DecodingTable& table) {
  const bool needs_signal = table.correction && table.correction->needs_signal();
  std::vector<DecodedPlane> planes;
  if (corrections.limits || corrections.mixed) planes = {DecodedPlane::depth, DecodedPlane::status};
  if (needs_signal) planes.push_back(DecodedPlane::signal);
  if (corrections.limits) planes.push_back(DecodedPlane::confidence);
  if (corrections.mixed) planes.push_back(DecodedPlane::deviation);
  std::sort(planes.begin(), planes.end());
  return planes;
}

bool must_keep_filtered(const PlaneCorrections& corrections,
                        const std::vector<DecodedPlane>& planes) {
  return corrections.mixed || corrections.limits ||
         std::any_of(planes.begin(), planes.end(), [](DecodedPlane plane) {
           return description_of(plane).use == PlaneUse::of_frames;
         });
}

void decode_frame(FramePipeline& pipeline, const PlaneCorrections& corrections, int first_row,
                  int rows, const DecodedView& decoded, const Progress& progress) {
  const auto width = static_cast<std::size_t>(pipeline.width()),
             first = static_cast<std::size_t>(first_row) * width,
             pixels = static_cast<std::size_t>(rows) * width;
  DecodedView planes = decoded;
  const DepthImage added =
      add_missing_planes(planes_for(corrections, pipeline.table()), pixels, planes);
  if (!pipeline.steps().filter || !corrections.mixed)
    return decode_once(pipeline, corrections, first, pixels, planes, {}, progress);
  const ProgressParts parts(progress, {1.0, 1.0});
  const RawView measured = pipeline.measured();
  UnfilteredPixels unfiltered{.measured = &measured};
  decode_once(pipeline, corrections, first, pixels, planes, unfiltered, parts[0]);
  const auto is_mixed = [](PixelStatus status) { return status == PixelStatus::mixed; };
  const PixelStatus* const statuses = planes.status;
  if (std::none_of(statuses, statuses + pixels, is_mixed)) return;
  unfiltered.mixed = Image<std::uint8_t>(rows, pipeline.width());
  std::transform(statuses, statuses + pixels, unfiltered.mixed.pixels.begin(), is_mixed);
  decode_once(pipeline, corrections, first, pixels, planes, unfiltered, parts[1]);
}

}  // namespace tofsmith

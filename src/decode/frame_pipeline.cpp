// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/frame_pipeline.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "core/shared/working_threads.hpp"
#include "decode/shared/frame_accumulator.hpp"

namespace tofsmith {

namespace {

class CpuPipeline final : public FramePipeline {
 public:
  CpuPipeline(const DepthDecoder& decoder, const FrameSteps& frame_steps, int height, int width)
      : FramePipeline(decoder, frame_steps, height, width),
        decoder_(decoder),
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
    if (!steps().filter) return decoder_.decode(measured(), decoded, progress);
    constexpr double effort = 8.0;  // relative to decoding, roughly
    const ProgressParts parts(progress, {effort, 1.0});
    filter_frame(parts[0], left_out);
    decoder_.decode(filtered_.view(), decoded, parts[1]);
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

  const DepthDecoder& decoder_;
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

/// Adds the planes that depth limits need and `decoded` lacks.
/// @return memory of the added planes
DepthImage planes_for_limits(std::size_t pixels, DecodedView& decoded) {
  const std::vector<DecodedPlane> wanted = decoded.planes();
  std::vector<DecodedPlane> missing;
  for (const DecodedPlane plane :
       {DecodedPlane::depth, DecodedPlane::confidence, DecodedPlane::status})
    if (std::find(wanted.begin(), wanted.end(), plane) == wanted.end()) missing.push_back(plane);
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
  const DepthImage unwanted = limits ? planes_for_limits(pixels, decoded) : DepthImage();
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

void decode_frame(FramePipeline& pipeline, const PlaneCorrections& corrections, int first_row,
                  int rows, const DecodedView& decoded, const Progress& progress) {
  const auto width = static_cast<std::size_t>(pipeline.width()),
             first = static_cast<std::size_t>(first_row) * width,
             pixels = static_cast<std::size_t>(rows) * width;
  if (!pipeline.steps().filter || !corrections.mixed)
    return decode_once(pipeline, corrections, first, pixels, decoded, {}, progress);
  const ProgressParts parts(progress, {1.0, 1.0});
  const RawView measured = pipeline.measured();
  UnfilteredPixels unfiltered{.measured = &measured};
  decode_once(pipeline, corrections, first, pixels, decoded, unfiltered, parts[0]);
  const auto is_mixed = [](PixelStatus status) { return status == PixelStatus::mixed; };
  const PixelStatus* const statuses = decoded.status;
  if (!statuses || std::none_of(statuses, statuses + pixels, is_mixed)) return;
  unfiltered.mixed = Image<std::uint8_t>(rows, pipeline.width());
  std::transform(statuses, statuses + pixels, unfiltered.mixed.pixels.begin(), is_mixed);
  decode_once(pipeline, corrections, first, pixels, decoded, unfiltered, parts[1]);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_backend.hpp"

#include <utility>

#include "core/shared/working_threads.hpp"
#include "decode/shared/frame_accumulator.hpp"
#include "gpu/device_frames.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Averages and filters in time on the device if it can, else on the CPU; filters in space and
/// decodes on the device.
class DevicePipeline final : public FramePipeline {
 public:
  DevicePipeline(const DeviceDecoder& decoder, const DeviceOptions& options,
                 const DecodingTable& decoding_table, const FrameSteps& frame_steps, int height,
                 int width)
      : FramePipeline(decoding_table, frame_steps, height, width), decoder_(decoder) {
    if (steps().filter) filter_.emplace(decoder.device(), *steps().filter, options);
    if (!accumulates_on_device()) {
      on_cpu_.emplace(table(), steps());
      return;
    }
    if (steps().time_filter) time_filter_.emplace(table(), *steps().time_filter);
    on_device_.emplace(decoder.device(), table(), time_filter_ ? &*time_filter_ : nullptr, options);
  }

  FrameMemory memory(int recorded) const override {
    FrameMemory memory;
    if (on_cpu_) memory = on_cpu_->memory(recorded, height(), width());
    const double pixels = static_cast<double>(height()) * width(),
                 numbers = sizeof(float) * pixels * (table().measurements() + 1);
    if (on_device_ && steps().keeps_filtered) memory.whole += numbers;
    if (const Filter* filter = steps().filter; filter && steps().keeps_filtered)
      memory.whole += static_cast<double>(Filter::memory_bytes(
          filter->options(), height(), width(), filter->measurements(), working_threads()));
    return memory;
  }

  bool submit(const RawView& raw, bool completes_mean) override {
    is_filtered_ = false;
    if (on_cpu_) {
      ready_ = on_cpu_->submit(raw, completes_mean);
      return ready_.has_value();
    }
    if (steps().average == 1) {
      on_device_->take(raw);
      return true;
    }
    on_device_->add(raw);
    if (completes_mean) on_device_->take_mean(steps().averaged);
    return completes_mean;
  }
  bool submit_end() override {
    is_filtered_ = false;
    if (on_cpu_) {
      ready_ = on_cpu_->submit_end();
      return ready_.has_value();
    }
    if (on_device_->frames_of_mean() == 0) return false;
    on_device_->take_mean(steps().averaged);
    return true;
  }

  void decode(const DecodedView& decoded, const Progress& progress,
              const Image<std::uint8_t>& left_out) override {
    FilteredFrame* const kept = steps().keeps_filtered ? &filtered_ : nullptr;
    if (on_cpu_ && filter_)
      filter_->decode(*ready_, decoder_, decoded, kept, progress, left_out);
    else if (on_cpu_)
      decoder_.decode(*ready_, decoded, progress);
    else if (filter_)
      on_device_->decode(*filter_, decoder_, decoded, kept, progress, left_out);
    else
      on_device_->decode(decoder_, decoded, progress);
    is_filtered_ = kept != nullptr;
  }
  RawView measured() override { return on_cpu_ ? ready_.value() : on_device_->numbers(); }
  RawView numbers(const Progress& progress) override {
    if (!filter_) return measured();
    if (!is_filtered_) filter_->apply(measured(), filtered_, progress);
    is_filtered_ = true;
    return filtered_.view();
  }

 private:
  bool accumulates_on_device() const {
    const bool averages = steps().average > 1;
    if (averages && !decoder_.device().info().has_doubles) return false;
    return steps().time_filter ? steps().time_filter->look_ahead == 0 : averages;
  }

  const DeviceDecoder& decoder_;
  std::optional<DeviceFilter> filter_;
  std::optional<TimeFilter> time_filter_;  // whose options the device uses
  std::optional<DeviceFrames> on_device_;  // averages and filters in time, unless on_cpu_ does
  std::optional<FrameAccumulator> on_cpu_;
  std::optional<RawView> ready_;  // from on_cpu_
  FilteredFrame filtered_;
  bool is_filtered_ = false;
};

class DeviceBackend final : public FrameBackend {
 public:
  DeviceBackend(const Device& device, std::unique_ptr<const DepthDecoder> decoder,
                const DeviceOptions& options, bool is_automatic)
      : cpu_(cpu_backend(std::move(decoder))),
        options_(options),
        is_automatic_(is_automatic),
        on_device_(device, *cpu_->decoder().correlation_decoder(), options) {}

  const DepthDecoder& decoder() const override { return cpu_->decoder(); }
  std::string device() const override { return on_device_.device().info().name; }
  std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                         int width) const override {
    const bool is_slow_to_process =
        steps.filter && std::int64_t{height} * width >= auto_min_pixels_to_filter;
    if (is_automatic_ && !is_slow_to_process) return cpu_->prepare(steps, height, width);
    return std::make_unique<DevicePipeline>(on_device_, options_, decoder().table(), steps, height,
                                            width);
  }

 private:
  std::unique_ptr<FrameBackend> cpu_;
  DeviceOptions options_;
  bool is_automatic_;
  DeviceDecoder on_device_;
};

}  // namespace

std::unique_ptr<FrameBackend> device_backend(const Device& device,
                                             std::unique_ptr<const DepthDecoder> decoder,
                                             const DeviceOptions& options, bool is_automatic) {
  return std::make_unique<DeviceBackend>(device, std::move(decoder), options, is_automatic);
}

std::unique_ptr<FrameBackend> frame_backend(std::string_view device,
                                            std::unique_ptr<const DepthDecoder> decoder,
                                            const DeviceOptions& options) {
  if (device == "cpu") return cpu_backend(std::move(decoder));
  const bool is_zncc = decoder->correlation_decoder() != nullptr;
  if (device == "auto") {
    const std::optional<Device> gpu = is_zncc ? Device::first_gpu() : std::nullopt;
    if (!gpu) return cpu_backend(std::move(decoder));
    return device_backend(*gpu, std::move(decoder), options, true);
  }
  require(is_zncc, "method", name_of(decoder->method()),
          "must be zncc, by which alone devices decode, or the device cpu");
  return device_backend(Device::named(device), std::move(decoder), options, false);
}

}  // namespace tofsmith

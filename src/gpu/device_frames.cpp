// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_frames.hpp"

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/shared/working_threads.hpp"
#include "decode/output/shared/decoder_parts.hpp"
#include "decode/shared/frame_accumulator.hpp"
#include "decode/shared/marked_raw.hpp"
#include "gpu/device_raw.hpp"
#include "gpu/device_time_filter.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

struct DeviceFrames::Plan {
  Plan(const Device& device_, const DecodingTable& table_, const TimeFilter* time_filter,
       const DeviceOptions& options_);

  /// Checks a new frame and drops the current one.
  void begin_frame(const RawView& raw, bool is_first);
  /// Drops all accumulated frames if steps fail half-way.
  template <typename Steps>
  auto on_device(const Steps& steps);
  void forget();
  FrameSource source();
  RawView numbers_here();

  Device device;
  const DecodingTable& table;
  DeviceOptions options;
  std::optional<DeviceMeans> means;  // created with the first mean
  std::optional<DeviceTimeFilter> filter;
  RawView size;          // only the shape
  int frames_added = 0;  // to the next mean
  bool has_frame = false;
  std::vector<float> numbers, averaged;  // downloaded
  std::vector<double> exact_numbers;
};

template <typename Steps>
auto DeviceFrames::Plan::on_device(const Steps& steps) {
  try {
    return steps();
  } catch (const InvalidArgument&) {
    throw;  // nothing was started
  } catch (const Interrupted&) {
    throw;  // accumulated frames are unchanged
  } catch (...) {
    forget();
    throw;
  }
}

DeviceFrames::Plan::Plan(const Device& device_, const DecodingTable& table_,
                         const TimeFilter* time_filter, const DeviceOptions& options_)
    : device(device_), table(table_), options(options_) {
  if (!time_filter) return;
  require(time_filter->measurements() == table.measurements(), "time filter's measurements",
          time_filter->measurements(), "must equal those of the table");
  require(time_filter->options().look_ahead == 0, "look_ahead", time_filter->options().look_ahead,
          "must be 0 on devices");
  filter.emplace(device, state_of(*time_filter));
}

void DeviceFrames::Plan::begin_frame(const RawView& raw, bool is_first) {
  require_frame(raw, table.measurements());
  require(is_first || raw.height == size.height, "raw height", raw.height,
          "must equal that of the previous frames, " + std::to_string(size.height));
  require(is_first || raw.width == size.width, "raw width", raw.width,
          "must equal that of the previous frames, " + std::to_string(size.width));
  size = RawView::interleaved(static_cast<const float*>(nullptr), raw.height, raw.width,
                              raw.measurements);
  has_frame = false;
}

void DeviceFrames::Plan::forget() {
  if (means) means->forget();
  if (filter) filter->forget();
  frames_added = 0;
  has_frame = false;
}

FrameSource DeviceFrames::Plan::source() {
  require(has_frame, "frame on the device", "none", "must be uploaded first");
  if (filter) return {.raw = size, .on_device = &filter->result(), .queue = &filter->queue()};
  return {.raw = size, .on_device = &means->result(), .queue = &means->queue(), .means = &*means};
}

DeviceFrames::DeviceFrames(const Device& device, const DecodingTable& table,
                           const TimeFilter* time_filter, const DeviceOptions& options) {
  options.validate();
  plan_ = make_hidden<Plan>(device, table, time_filter, options);
}

int DeviceFrames::frames_of_mean() const { return plan_->frames_added; }

void DeviceFrames::add(const RawView& raw) {
  Plan& plan = *plan_;
  const bool is_first = plan.frames_added == 0 && !(plan.filter && !plan.filter->is_empty());
  plan.begin_frame(raw, is_first);
  if (!plan.means) plan.means.emplace(plan.device, SaturationLevels(plan.table));
  const MarkedRaw marked(raw, plan.table.marking);
  plan.on_device([&] { plan.means->add(marked.view()); });
  ++plan.frames_added;
}

void DeviceFrames::take_mean(double averaged) {
  Plan& plan = *plan_;
  require(plan.frames_added > 0, "frames of a mean", plan.frames_added, "must be > 0");
  require(averaged > 0.0, "averaged", averaged, "must be > 0");
  plan.on_device([&] {
    plan.means->finish(averaged);
    plan.frames_added = 0;
    if (!plan.filter) {
      plan.has_frame = true;
      return;
    }
    const DeviceQueue &of_means = plan.means->queue(), &of_filter = plan.filter->queue();
    of_filter.follow(of_means.mark());
    plan.filter->add(plan.means->result(), plan.size.height, plan.size.width);
    plan.has_frame = true;
    of_means.follow(of_filter.mark());
  });
}

void DeviceFrames::take(const RawView& raw) {
  Plan& plan = *plan_;
  require(plan.filter.has_value(), "time filter", "none",
          "is required for frames that are not means");
  plan.begin_frame(raw, plan.filter->is_empty());
  const MarkedRaw marked(raw, plan.table.marking);
  plan.on_device([&] { plan.filter->add(marked.view()); });
  plan.has_frame = true;
}

void DeviceFrames::forget() { plan_->forget(); }

bool DeviceFrames::has_frame() const { return plan_->has_frame; }

RawView DeviceFrames::numbers() {
  return plan_->on_device([this] { return plan_->numbers_here(); });
}

RawView DeviceFrames::Plan::numbers_here() {
  const FrameSource source = this->source();
  const auto pixels = static_cast<std::size_t>(source.pixels()),
             count = pixels * static_cast<std::size_t>(size.measurements);
  averaged.resize(pixels);
  source.queue->download(*source.on_device->averaged(), pixels * sizeof(float), averaged.data());
  const int height = size.height, width = size.width, k = size.measurements;
  RawView view;
  if (source.means) {
    exact_numbers = source.means->numbers();
    view = RawView::planar(exact_numbers.data(), height, width, k);
  } else {
    numbers.resize(count);
    source.queue->download(*source.on_device->numbers(), count * sizeof(float), numbers.data());
    view = RawView::planar(numbers.data(), height, width, k);
  }
  return marked_view(view, averaged.data());
}

std::int64_t DeviceFrames::decode(const DeviceDecoder& decoder, const DecodedView& decoded,
                                  const Progress& progress) {
  return plan_->on_device(
      [&] { return decoder.decode_source(plan_->source(), plan_->device, decoded, progress); });
}

std::int64_t DeviceFrames::decode(const DeviceFilter& filter, const DeviceDecoder& decoder,
                                  const DecodedView& decoded, FilteredFrame* filtered,
                                  const Progress& progress, const Image<std::uint8_t>& left_out) {
  return plan_->on_device([&] {
    return filter.decode_source(plan_->source(), plan_->device, decoder, decoded, filtered,
                                progress, left_out);
  });
}

namespace {

/// Averages and filters in time on the device if possible, else on the CPU. Other steps run on the
/// device.
class DevicePipeline final : public FramePipeline {
 public:
  DevicePipeline(const DeviceDecoder& decoder, const DeviceOptions& options,
                 const DepthDecoder& depth_decoder, const FrameSteps& frame_steps, int height,
                 int width)
      : FramePipeline(depth_decoder, frame_steps, height, width), decoder_(decoder) {
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
    if (const Filter* filter = steps().filter;
        filter && (steps().keeps_filtered || has_deviation_factors()))
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
    const bool keeps = steps().keeps_filtered || (decoded.deviation_m && has_deviation_factors());
    FilteredFrame* const kept = keeps ? &filtered_ : nullptr;
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
  const Image<float>& deviation_factor() const override { return filtered_.deviation_factor(); }

 private:
  bool has_deviation_factors() const {
    return steps().filter && steps().filter->options().slope_rounds > 0;
  }
  bool accumulates_on_device() const {
    const bool averages = steps().average > 1;
    if (averages && !decoder_.device().info().has_doubles) return false;
    return steps().time_filter ? steps().time_filter->look_ahead == 0 : averages;
  }

  const DeviceDecoder& decoder_;
  std::optional<DeviceFilter> filter_;
  std::optional<TimeFilter> time_filter_;
  std::optional<DeviceFrames> on_device_;  // unless on_cpu_ does
  std::optional<FrameAccumulator> on_cpu_;
  std::optional<RawView> ready_;  // from on_cpu_
  FilteredFrame filtered_;
  bool is_filtered_ = false;
};

class DeviceBackend final : public FrameBackend {
 public:
  DeviceBackend(const Device& device, std::unique_ptr<const DepthDecoder> decoder,
                const DeviceOptions& options)
      : cpu_(cpu_backend(std::move(decoder))),
        options_(options),
        on_device_(device, *cpu_->decoder().correlation_decoder(), options) {}

  const DepthDecoder& decoder() const override { return cpu_->decoder(); }
  std::string device() const override { return on_device_.device().info().name; }
  std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                         int width) const override {
    return std::make_unique<DevicePipeline>(on_device_, options_, decoder(), steps, height, width);
  }

 private:
  std::unique_ptr<FrameBackend> cpu_;  // owns the decoder
  DeviceOptions options_;
  DeviceDecoder on_device_;
};

/// Loads no driver before a frame needs it.
class AutomaticBackend final : public FrameBackend {
 public:
  AutomaticBackend(DeviceFinder find_device, std::unique_ptr<const DepthDecoder> decoder,
                   const DeviceOptions& options)
      : find_device_(std::move(find_device)),
        cpu_(cpu_backend(std::move(decoder))),
        options_(options) {}

  const DepthDecoder& decoder() const override { return cpu_->decoder(); }
  std::string device() const override {
    const std::lock_guard lock(mutex_);
    return on_device_ ? on_device_->device().info().name : cpu_->device();
  }
  std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                         int width) const override {
    const bool is_slow_on_cpu =
        steps.filter && std::int64_t{height} * width >= auto_min_pixels_to_filter;
    if (!is_slow_on_cpu || !has_device()) return cpu_->prepare(steps, height, width);
    return std::make_unique<DevicePipeline>(*on_device_, options_, decoder(), steps, height, width);
  }

 private:
  bool has_device() const {
    const std::lock_guard lock(mutex_);
    if (!has_looked_)
      if (const std::optional<Device> device = find_device_())
        on_device_.emplace(*device, *decoder().correlation_decoder(), options_);
    has_looked_ = true;
    return on_device_.has_value();
  }

  DeviceFinder find_device_;
  std::unique_ptr<FrameBackend> cpu_;
  DeviceOptions options_;
  mutable std::mutex mutex_;
  mutable bool has_looked_ = false;
  mutable std::optional<DeviceDecoder> on_device_;  // set once
};

}  // namespace

std::unique_ptr<FrameBackend> automatic_backend(DeviceFinder find_device,
                                                std::unique_ptr<const DepthDecoder> decoder,
                                                const DeviceOptions& options) {
  return std::make_unique<AutomaticBackend>(std::move(find_device), std::move(decoder), options);
}

std::unique_ptr<FrameBackend> frame_backend(std::string_view device,
                                            std::unique_ptr<const DepthDecoder> decoder,
                                            const DeviceOptions& options) {
  if (device == "cpu") return cpu_backend(std::move(decoder));
  const bool is_zncc = decoder->correlation_decoder() != nullptr;
  if (device == "auto") {
    options.validate();
    return is_zncc ? automatic_backend(Device::first_gpu, std::move(decoder), options)
                   : cpu_backend(std::move(decoder));
  }
  require(is_zncc, "method", name_of(decoder->method()),
          "must be zncc, the only method of OpenCL devices, or the device must be cpu");
  return std::make_unique<DeviceBackend>(Device::named(device), std::move(decoder), options);
}

}  // namespace tofsmith

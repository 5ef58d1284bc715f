// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "decode/output/shared/decoder_parts.hpp"
#include "decode/shared/marked_raw.hpp"
#include "decode/shared/saturation_level.hpp"
#include "gpu/device_frames_plan.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

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
  plan_ = std::make_unique<Plan>(device, table, time_filter, options);
}
DeviceFrames::~DeviceFrames() = default;
DeviceFrames::DeviceFrames(DeviceFrames&&) noexcept = default;
DeviceFrames& DeviceFrames::operator=(DeviceFrames&&) noexcept = default;

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
  view.averaged = averaged.data();
  view.is_marked = true;
  return view;
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

}  // namespace tofsmith

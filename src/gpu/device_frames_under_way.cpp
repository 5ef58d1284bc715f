// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "gpu/device_decoder_plan.hpp"
#include "gpu/device_frames_plan.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

struct DeviceFramesUnderWay::Plan {
  /// A frame under way, and its memory.
  struct Slot {
    std::unique_ptr<DeviceTile> tile;  // once there is a frame
    DeviceRaw brought;                 // that is filtered
    FrameSource source;                // of what is decoded in the tile
    DecodedView planes;
    std::optional<std::int64_t> left;  // to the decoder, once all of it is done
  };

  const DeviceDecoder& decoder;
  const DeviceFilter* filter;
  DeviceFrames* frames;
  std::array<Slot, 2> slots;
  std::size_t first = 0, count = 0;  // of those under way

  DeviceDecoder::Plan& decoding() const { return *decoder.plan_; }
  bool has_frame() const { return frames && frames->has_frame(); }
  void start(Slot& slot, const RawView& raw);
  bool starts_beside(Slot& slot, const RawView& raw) const;
  bool starts_on_device(Slot& slot, FrameSource source) const;
  std::int64_t decode_alone(const RawView& raw, const DecodedView& planes) const;
  void finish(Slot& slot) const;
  void forget();
};

/// Begins with it beside the other one; false where it does not go so.
bool DeviceFramesUnderWay::Plan::starts_beside(Slot& slot, const RawView& raw) const {
  const bool is_there = has_frame();
  if (!is_there && !filter) return false;
  FrameSource source{.raw = raw};
  if (is_there) source = frames->plan_->source();
  require(decoding().decoder.measurements() == source.raw.measurements, "decoder's measurements",
          decoding().decoder.measurements(), "must be those of the frame");
  if (!slot.tile)
    slot.tile = std::make_unique<DeviceTile>(decoder.device(), decoding().decoder,
                                             decoding().options.use_doubles);
  return starts_on_device(slot, source);
}

bool DeviceFramesUnderWay::Plan::starts_on_device(Slot& slot, FrameSource source) const {
  if (filter) {
    if (!filter->start(source, slot.brought, *slot.tile, slot.planes)) return false;
    // What is decoded are the numbers that were filtered.
    slot.source = {.raw = source.raw, .on_device = &slot.tile->raw()};
    return true;
  }
  {
    const std::lock_guard lock(decoding().mutex);
    if (source.pixels() > decoding().tile_pixels) return false;
  }
  if (source.means) source.means->keep_sums();
  slot.source = source;
  DeviceDecoder::Plan::start(*slot.tile, source, {0, source.pixels()}, slot.planes);
  return true;
}

std::int64_t DeviceFramesUnderWay::Plan::decode_alone(const RawView& raw,
                                                      const DecodedView& planes) const {
  if (filter)
    return has_frame() ? frames->decode(*filter, decoder, planes)
                       : filter->decode(raw, decoder, planes);
  return has_frame() ? frames->decode(decoder, planes) : decoder.decode(raw, planes);
}

void DeviceFramesUnderWay::Plan::start(Slot& slot, const RawView& raw) {
  slot.left.reset();
  try {
    if (starts_beside(slot, raw)) return;
  } catch (const OutOfDeviceMemory&) {  // for two: one after another takes less
    for (std::size_t i = 0; i < count; ++i) finish(slots[(first + i) % 2]);
    for (Slot& each : slots) {
      each.tile.reset();
      each.brought.release();
    }
  }
  slot.left = decode_alone(raw, slot.planes);
}

void DeviceFramesUnderWay::Plan::finish(Slot& slot) const {
  if (slot.left) return;
  const FramePart all{0, slot.source.pixels()};
  slot.left = decoding().finish(*slot.tile, slot.source, all, slot.planes);
}

void DeviceFramesUnderWay::Plan::forget() {
  count = 0;
  if (frames) frames->forget();
}

DeviceFramesUnderWay::DeviceFramesUnderWay(const DeviceDecoder& decoder, const DeviceFilter* filter,
                                           DeviceFrames* frames) {
  const auto require_here = [&](const char* whose, const Device& device) {
    require(&device.state() == &decoder.device().state(), whose, device.info().name,
            "must be that of the decoder, or a copy");
  };
  if (filter) require_here("filter's device", filter->device());
  if (frames) require_here("device of frames", frames->plan_->device);
  plan_ = std::make_unique<Plan>(Plan{.decoder = decoder, .filter = filter, .frames = frames});
}
DeviceFramesUnderWay::~DeviceFramesUnderWay() = default;
DeviceFramesUnderWay::DeviceFramesUnderWay(DeviceFramesUnderWay&&) noexcept = default;
DeviceFramesUnderWay& DeviceFramesUnderWay::operator=(DeviceFramesUnderWay&&) noexcept = default;

void DeviceFramesUnderWay::start(const RawView& raw, const DecodedView& decoded) {
  Plan& plan = *plan_;
  require(plan.count < plan.slots.size(), "frames under way", plan.count, "must be < 2");
  Plan::Slot& slot = plan.slots[(plan.first + plan.count) % 2];
  slot.planes = decoded;
  try {
    plan.start(slot, MarkedRaw(raw, plan.decoding().decoder.table().marking).view());
  } catch (const IoError&) {
    plan.forget();
    throw;
  }
  ++plan.count;
}

std::int64_t DeviceFramesUnderWay::finish() {
  Plan& plan = *plan_;
  require(plan.count > 0, "frames under way", plan.count, "must be > 0");
  Plan::Slot& slot = plan.slots[plan.first];
  try {
    plan.finish(slot);
  } catch (const IoError&) {
    plan.forget();
    throw;
  }
  plan.first = 1 - plan.first;
  --plan.count;
  return *slot.left;
}

void DeviceFramesUnderWay::forget() { plan_->forget(); }

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gpu/device_filter.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// Averages frames and filters them in time (as TimeFilter) on a device, where they stay for
/// spatial filters and decoders on the same device. For the equality of results see DeviceFilter.
/// The accumulated frame stays on the device in full, regardless of DeviceOptions::memory_mb. Not
/// thread-safe.
class DeviceFrames {
 public:
  /// Compiles the kernels.
  /// @param table        provides the saturation levels; must outlive this object
  /// @param time_filter  without look_ahead; must outlive this object; null: means only
  /// @throws std::invalid_argument for invalid options or filters; IoError if the device fails
  DeviceFrames(const Device& device, const DecodingTable& table, const TimeFilter* time_filter,
               const DeviceOptions& options = {});

  /// Adds a frame to the next mean. Numbers that are invalid or saturated in one frame are so in
  /// the mean.
  /// @throws std::invalid_argument if measurements or sizes differ, or the device has no doubles;
  ///     IoError if the device fails, which also drops the accumulated frames
  void add(const RawView& raw);
  int frames_of_mean() const;
  /// Makes the mean of the added frames the current frame.
  /// @param averaged  measurements already averaged in each added frame
  /// @throws as add(); std::invalid_argument if no frame was added
  void take_mean(double averaged = 1.0);
  /// Filters a frame in time and makes the result the current frame.
  /// @throws as add()
  void take(const RawView& raw);
  /// Starts a new sequence, of any size.
  void forget();

  bool has_frame() const;
  /// Downloads the current frame, valid until the next one: the result of TimeFilter::add(), or the
  /// mean in doubles.
  /// @throws std::invalid_argument if there is no frame; IoError if the device fails
  RawView numbers();
  /// Decodes the current frame, as DeviceDecoder::decode.
  /// @return number of pixels that the CPU decoded
  std::int64_t decode(const DeviceDecoder& decoder, const DecodedView& decoded,
                      const Progress& progress = {});
  /// Filters and decodes the current frame, as DeviceFilter::decode.
  /// @return number of pixels that the CPU decoded
  std::int64_t decode(const DeviceFilter& filter, const DeviceDecoder& decoder,
                      const DecodedView& decoded, FilteredFrame* filtered = nullptr,
                      const Progress& progress = {}, const Image<std::uint8_t>& left_out = {});

 private:
  struct Plan;
  Hidden<Plan> plan_;
};

/// Returns the device that `auto` uses, or nothing.
using DeviceFinder = std::function<std::optional<Device>()>;

/// Returns the backend for `auto`: the CPU for frames without a spatial filter or below
/// auto_min_pixels_to_filter, else the device, which is looked up when first needed.
/// @param decoder  must use DecodeMethod::zncc
std::unique_ptr<FrameBackend> automatic_backend(DeviceFinder find_device,
                                                std::unique_ptr<const DepthDecoder> decoder,
                                                const DeviceOptions& options);

}  // namespace tofsmith

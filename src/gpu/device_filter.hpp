// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gpu/device_decoder.hpp"

namespace tofsmith {

/// A Filter on a device, optionally followed by a decoder on the same device. For the equality of
/// results see frame_backend(); where rounding differs, values near a threshold may change by more
/// than the last bits. Thread-safe; calls are serialized.
class DeviceFilter {
 public:
  /// Compiles the kernels and uploads the tables.
  /// @param filter  must outlive this object
  /// @throws std::invalid_argument for invalid options; IoError if the device fails
  DeviceFilter(const Device& device, const Filter& filter, const DeviceOptions& options = {});
  DeviceFilter(const Device& device, Filter&& filter, const DeviceOptions& options = {}) = delete;
  ~DeviceFilter();
  DeviceFilter(DeviceFilter&&) noexcept;
  DeviceFilter& operator=(DeviceFilter&&) noexcept;

  const Device& device() const;

  /// Filters a frame, as Filter::apply.
  /// @throws std::invalid_argument if the measurements or sizes differ; IoError if the device
  ///         fails; Interrupted if `progress` cancels
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// As above for a frame of `raw` (F, H, W, K).
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Filters and decodes a frame.
  /// @param decoder   on the same device
  /// @param filtered  receives the filtered frame unless null
  /// @return number of pixels that the CPU decoded
  /// @throws as apply() and DeviceDecoder::decode; planes may be partly written
  std::int64_t decode(const RawView& raw, const DeviceDecoder& decoder, const DecodedView& decoded,
                      FilteredFrame* filtered = nullptr, const Progress& progress = {},
                      const Image<std::uint8_t>& left_out = {}) const;

 private:
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DeviceDecoder& decoder, const DecodedView& decoded,
                             FilteredFrame* filtered, const Progress& progress,
                             const Image<std::uint8_t>& left_out) const;
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofsmith

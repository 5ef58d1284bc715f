// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gpu/device_decoder.hpp"

namespace tofsmith {

/// A Filter whose work a device does, and a decoder's after it, with frames that stay there between
/// the two. Numbers are those of the Filter: the same bits where the device rounds quotients and
/// roots correctly and has doubles, else they differ in the last ones, and where a threshold lies
/// between, by more.
///
/// Safe to use from many threads, which wait for one another.
class DeviceFilter {
 public:
  /// Compiles kernels for the table and brings its tables to the device.
  /// @param filter  must outlive this one
  /// @throws std::invalid_argument for options; IoError if the device fails, with what its compiler
  ///         says of kernels
  DeviceFilter(const Device& device, const Filter& filter, const DeviceOptions& options = {});
  DeviceFilter(const Device& device, Filter&& filter, const DeviceOptions& options = {}) = delete;
  ~DeviceFilter();
  DeviceFilter(DeviceFilter&&) noexcept;
  DeviceFilter& operator=(DeviceFilter&&) noexcept;

  const Device& device() const;

  /// Filters one frame, as Filter::apply.
  /// @throws std::invalid_argument if the measurements or sizes differ; IoError if the device
  /// fails;
  ///         Interrupted if progress says so
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// The same for frame `frame` of several (F, H, W, K).
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Filters one frame and has it decoded on the device, into the caller's planes.
  /// @param decoder   on the same device
  /// @param filtered  brought back as well; null: not wanted
  /// @return how many pixels were left to the Decoder
  /// @throws as apply() and DeviceDecoder::decode, with part of the planes written
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

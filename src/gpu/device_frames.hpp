// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gpu/device_filter.hpp"

namespace tofsmith {

/// Means of frames, and frames added up in time as a TimeFilter does, on a device, where they stay
/// for the filter in space and the decoder. Numbers are those of the processor: the same bits where
/// the device rounds quotients and roots correctly, else they differ in the last ones, and where a
/// threshold lies between, by more.
///
/// Keeps what was added up whole, whatever DeviceOptions::memory_mb says.
/// Not for several threads at once.
class DeviceFrames {
 public:
  /// Compiles kernels for the table.
  /// @param table        must outlive this one; says from where on raw numbers are clipped
  /// @param time_filter  without look_ahead; must outlive this; null: means only
  /// @throws std::invalid_argument for options, and a filter of other measurements or that looks
  ///         ahead; IoError if the device fails
  DeviceFrames(const Device& device, const DecodingTable& table, const TimeFilter* time_filter,
               const DeviceOptions& options = {});
  ~DeviceFrames();
  DeviceFrames(DeviceFrames&&) noexcept;
  DeviceFrames& operator=(DeviceFrames&&) noexcept;

  /// Adds a frame to those of which the next mean is. What is invalid or saturated in one is so in
  /// the mean.
  /// @throws std::invalid_argument if the measurements or sizes differ, or the device has no
  ///         doubles; IoError if the device fails, after which the next frame is the first
  void add(const RawView& raw);
  /// Number of frames added to the next mean.
  int frames_of_mean() const;
  /// The mean of those is the next frame.
  /// @param averaged  of how many measurements the numbers of one are the mean
  /// @throws as add(); std::invalid_argument if there are none
  void take_mean(double averaged = 1.0);
  /// The next frame, without a mean, of a time filter. @throws as add()
  void take(const RawView& raw);
  /// The next frame is the first again, of any size.
  void forget();

  /// Whether there is a frame to decode.
  bool has_frame() const;
  /// Brings the frame back, until the next one: what TimeFilter::add() gives, or the mean in
  /// doubles.
  /// @throws std::invalid_argument if there is none; IoError if the device fails
  RawView numbers();
  /// Decodes the frame, as DeviceDecoder::decode.
  /// @param decoder  on the same device
  /// @return how many pixels were left to the Decoder
  std::int64_t decode(const DeviceDecoder& decoder, const DecodedView& decoded,
                      const Progress& progress = {});
  /// Filters the frame, as DeviceFilter::decode, and decodes it.
  /// @param filter   on the same device
  /// @param decoder  likewise
  /// @return how many pixels were left to the Decoder
  std::int64_t decode(const DeviceFilter& filter, const DeviceDecoder& decoder,
                      const DecodedView& decoded, FilteredFrame* filtered = nullptr,
                      const Progress& progress = {}, const Image<std::uint8_t>& left_out = {});

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofsmith

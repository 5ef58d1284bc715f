// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gpu/decode_tables.hpp"
#include "gpu/frame_source.hpp"

namespace tofsmith {

/// Numbers of pixels that a device leaves open: K, and of how many measurements they are the mean.
class OpenNumbers {
 public:
  OpenNumbers(std::vector<float> numbers, int measurements, const NoiseRatios& noise);
  /// A frame of one row.
  RawView view() const;

 private:
  int measurements_;
  NoiseRatios noise_;
  std::vector<float> numbers_, averaged_;
};

/// A tile of pixels on a device: brought there or made there, decoded there, and fetched. Its
/// memory there grows with the largest tile.
class DeviceTile {
 public:
  /// @param decoder  must outlive this
  DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles);

  /// Of a pixel with all of its planes, at most.
  std::int64_t bytes_per_pixel() const;

  /// Brings pixels first .. first + count - 1 of a frame, row by row.
  void bring(const FrameSource& frame, std::int64_t first, std::int64_t count) {
    frame.bring(queue_, raw_, first, count);
  }
  /// Makes room for so many pixels whose numbers, and of how many they are the mean, a kernel
  /// writes: DeviceRaw::reserve_planes().
  const DeviceRaw& reserve_planes(std::int64_t pixels, const NoiseRatios& noise = {});
  /// Starts to decode them into planes of the device.
  /// @param wanted  those that are not null
  void decode(const DecodedView& wanted);
  /// Fetches the planes that `decode` was asked for.
  /// @param to  where the tile's first pixel belongs
  void fetch(const DecodedView& to) const;
  /// Frees its memory there, but for the decoder's tables.
  void release();
  /// Pixels of the tile that the decoder has to decode; one may be named twice.
  std::vector<std::int32_t> open_pixels() const;
  /// What OpenNumbers takes of those.
  std::vector<float> numbers_of(const std::vector<std::int32_t>& open);
  /// Puts what the decoder says of those into the planes of depth and deviation.
  void put_depth(const std::vector<std::int32_t>& open, const std::vector<float>& depth_m,
                 const std::vector<float>& deviation_m);

  const DeviceQueue& queue() const { return queue_; }
  const DeviceRaw& raw() const { return raw_; }
  const DeviceMemory* plane(DecodedPlane plane) const {
    return &planes_[static_cast<std::size_t>(plane)];
  }

 private:
  DeviceMemory* room(DeviceMemory& memory, std::int64_t bytes) const {
    return reserve(queue_, memory, bytes);
  }
  const DeviceMemory* room_for(DecodedPlane plane, const DecodedView& wanted);
  void start_list_of_open();
  void find_bins(const MatchParameters& parameters, const DeviceMemory& bins) const;

  std::int32_t nearest_bin(std::int32_t row) const {
    return nearest_bin_of_row(row, outputs_.constants().samples, bin_count_);
  }

  const OutputKernel& outputs_;
  int bin_count_;
  DecodeTables tables_;
  DeviceQueue queue_;
  DeviceKernel match_, write_, gather_, scatter_;
  DeviceMemory words_;  // of the tables
  DeviceRaw raw_;
  DeviceMemory bins_, best_bins_, opened_, open_, some_numbers_;
  std::array<DeviceMemory, plane_descriptions.size()> planes_;  // of written_planes
};

}  // namespace tofsmith

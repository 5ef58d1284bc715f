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

/// Raw numbers of open pixels, K each, with the number averaged.
class OpenNumbers {
 public:
  OpenNumbers(std::vector<float> numbers, int measurements, const NoiseRatios& noise);
  /// As a frame of one row.
  RawView view() const;

 private:
  int measurements_;
  NoiseRatios noise_;
  std::vector<float> numbers_, averaged_;
};

/// Pixels on a device: uploaded or written there, decoded, and downloaded.
class DeviceTile {
 public:
  /// @param decoder  must outlive this object
  DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles);

  /// Upper limit, with all planes.
  std::int64_t bytes_per_pixel() const;

  void bring(const FrameSource& frame, std::int64_t first, std::int64_t count) {
    frame.bring(queue_, raw_, first, count);
  }
  /// Reserves memory for pixels that a kernel writes.
  const DeviceRaw& reserve_planes(std::int64_t pixels, const NoiseRatios& noise = {});
  /// @param wanted  planes that are null are not computed
  void decode(const DecodedView& wanted);
  /// @param to  starts at the tile's first pixel
  void fetch(const DecodedView& to) const;
  /// Keeps the decoder's tables.
  void release();
  /// Pixels that the CPU must decode; may contain duplicates.
  std::vector<std::int32_t> open_pixels() const;
  std::vector<float> open_numbers(const std::vector<std::int32_t>& open);
  /// Writes depths and deviations decoded by the CPU.
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
  std::array<DeviceMemory, plane_descriptions.size()> planes_;  // written_planes
};

}  // namespace tofsmith

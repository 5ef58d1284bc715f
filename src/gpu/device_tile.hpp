// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/decode_tables.hpp"
#include "gpu/device_queue.hpp"

namespace tofsmith {

/// A tile of pixels on a device: brought there, decoded there, and fetched. Its memory there grows
/// with the largest tile.
class DeviceTile {
 public:
  /// @param decoder  must outlive this
  DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles);

  /// Of a pixel with all of its planes, at most.
  std::int64_t bytes_per_pixel() const;

  /// Brings pixels first .. first + count - 1 of a frame, row by row.
  void upload(const RawView& view, std::int64_t first, std::int64_t count);
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

  const DeviceQueue& queue() const { return queue_; }

 private:
  DeviceMemory* reserve(DeviceMemory& memory, std::int64_t bytes) const;
  template <typename Value>
  DeviceMemory* reserve_for(const Value* plane, DeviceMemory& memory) const {
    return plane ? reserve(memory, tile_.pixels * std::int64_t{sizeof(Value)}) : nullptr;
  }
  void find_bins(const MatchParameters& parameters, const DeviceMemory& bins,
                 const DeviceMemory* second_peaks) const;

  const OutputKernel& outputs_;
  DecodeTables tables_;
  DeviceQueue queue_;
  DeviceKernel match_, write_;
  DeviceMemory words_;  // of the tables
  TileParameters tile_{};
  bool has_averaged_ = false;
  DeviceMemory raw_, averaged_, bins_, best_bins_, second_peaks_, opened_, open_;
  DeviceMemory depth_, signal_, ambient_, confidence_, deviation_, status_;
};

}  // namespace tofsmith

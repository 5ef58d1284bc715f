// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gpu/decode_parameters.h"
#include "gpu/device_queue.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Memory of a device that holds at least so many bytes; what it held is lost if it grows.
DeviceMemory* reserve(const DeviceQueue& queue, DeviceMemory& memory, std::int64_t bytes);

/// Raw numbers of some pixels on a device, and of how many measurements they are the mean. Memory
/// there grows with the most pixels.
class DeviceRaw {
 public:
  /// Brings pixels first .. first + count - 1 of a frame, row by row.
  void upload(const DeviceQueue& queue, const RawView& view, std::int64_t first,
              std::int64_t count);
  /// The same with doubles as they are, of which means are made.
  void upload_exactly(const DeviceQueue& queue, const RawView& view);
  /// Copies pixels first .. first + count - 1 of a frame that is on the device.
  void copy(const DeviceQueue& queue, const DeviceRaw& frame, int measurements, std::int64_t first,
            std::int64_t count);
  /// Makes room for floats, measurement after measurement, that a kernel writes; all of them are
  /// means.
  /// @param number  raw_float or raw_rounded
  void reserve_planes(const DeviceQueue& queue, std::int64_t pixels, int measurements,
                      RawNumber number = raw_float, const NoiseRatios& noise = {});
  void release();
  /// Of a frame, at most.
  static std::int64_t bytes_per_pixel(const RawView& raw) { return 4 * (raw.measurements + 1); }

  std::int64_t pixels() const { return tile_.pixels; }
  const TileParameters& tile() const { return tile_; }
  const DeviceMemory* numbers() const { return &numbers_; }
  /// Null where they are no means.
  const DeviceMemory* averaged() const { return has_averaged_ ? &averaged_ : nullptr; }
  const NoiseRatios& noise() const { return noise_; }

 private:
  template <bool exactly>
  void upload_numbers(const DeviceQueue& queue, const RawView& view, std::int64_t first,
                      std::int64_t count);

  TileParameters tile_{};
  bool has_averaged_ = false;
  NoiseRatios noise_;
  DeviceMemory numbers_, averaged_;
};

}  // namespace tofsmith

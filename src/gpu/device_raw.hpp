// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gpu/decode_parameters.h"
#include "gpu/device_queue.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Ensures that `memory` holds at least `bytes`; growth discards the contents.
DeviceMemory* reserve(const DeviceQueue& queue, DeviceMemory& memory, std::int64_t bytes);

/// Raw numbers of pixels on a device, with averaged counts.
class DeviceRaw {
 public:
  /// Uploads pixels [first, first + count) of a frame.
  void upload(const DeviceQueue& queue, const RawView& view, std::int64_t first,
              std::int64_t count);
  /// Uploads a frame without rounding doubles.
  void upload_exactly(const DeviceQueue& queue, const RawView& view);
  /// Copies pixels of a frame on the device.
  void copy(const DeviceQueue& queue, const DeviceRaw& frame, int measurements, std::int64_t first,
            std::int64_t count);
  /// Reserves planes of floats, one per measurement and one of averaged counts, for a kernel to
  /// fill.
  /// @param number  raw_float or raw_rounded
  void reserve_planes(const DeviceQueue& queue, std::int64_t pixels, int measurements,
                      RawNumber number = raw_float, const NoiseRatios& noise = {});
  void release();
  static std::int64_t bytes_per_pixel(const RawView& raw) { return 4 * (raw.measurements + 1); }

  std::int64_t pixels() const { return tile_.pixels; }
  const TileParameters& tile() const { return tile_; }
  const DeviceMemory* numbers() const { return &numbers_; }
  /// Null if the numbers are not means.
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

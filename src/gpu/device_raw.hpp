// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "decode/shared/marked_raw.hpp"
#include "gpu/device_queue.hpp"
#include "gpu/kernel_parameters.h"
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

/// Source of the kernels.
extern const std::string_view mean_kernels;

/// Means of frames on a device with doubles, with the same bits as on the CPU.
class DeviceMeans {
 public:
  /// @param levels  numbers clipped in one frame are clipped in the mean
  DeviceMeans(const Device& device, const SaturationLevels& levels);

  /// Adds a frame; `raw` is not accessed after the call.
  void add(const RawView& raw);
  /// Computes the mean of the frames added since the last one.
  /// @param averaged  measurements already averaged in each added frame
  void finish(double averaged);
  void forget() { frames_ = 0; }

  /// Rounded to floats.
  const DeviceRaw& result() const { return result_; }
  /// Unrounded mean at some pixels (K numbers each).
  std::vector<double> open_numbers(const std::vector<std::int32_t>& pixels);
  /// Unrounded mean, measurement by measurement.
  std::vector<double> numbers() const;
  const DeviceQueue& queue() const { return queue_; }

 private:
  DeviceQueue queue_;
  DeviceKernel add_to_sums_, write_means_, gather_means_;
  SaturationLevels levels_;
  struct Sums {
    std::int32_t pixels = 0, frames = 0;
    DeviceMemory memory;
  };
  std::int32_t measurements_ = 0, frames_ = 0;
  Sums sums_;
  DeviceRaw frame_, result_;
  DeviceMemory wanted_, gathered_;
};

/// A frame in host or device memory.
struct FrameSource {
  RawView raw;                           ///< only the shape if the frame is on the device
  const DeviceRaw* on_device = nullptr;  ///< null if the frame is on the host
  const DeviceQueue* queue = nullptr;    ///< queue that writes the frame
  DeviceMeans* means = nullptr;          ///< unrounded source of on_device, if a mean

  std::int64_t pixels() const { return raw.pixels(); }
  /// Copies pixels [first, first + count) to `to`, once work on the frame is done. The frame is not
  /// overwritten before the copy is complete.
  void bring(const DeviceQueue& to_queue, DeviceRaw& to, std::int64_t first,
             std::int64_t count) const {
    if (!on_device) return to.upload(to_queue, raw, first, count);
    to_queue.follow(queue->mark());
    to.copy(to_queue, *on_device, raw.measurements, first, count);
    queue->follow(to_queue.mark());
  }
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "decode/shared/saturation_level.hpp"
#include "gpu/device_raw.hpp"

namespace tofsmith {

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

}  // namespace tofsmith

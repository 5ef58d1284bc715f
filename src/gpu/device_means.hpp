// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "decode/shared/saturation_level.hpp"
#include "gpu/device_raw.hpp"

namespace tofsmith {

/// decode_parameters.h, numbers.cl and means.cl, one behind the other.
extern const std::string_view mean_kernels;

/// Means of frames on a device that has doubles, to the last bit those of this computer. Its memory
/// there grows with the largest frame.
class DeviceMeans {
 public:
  /// @param levels  numbers that are clipped in one frame are clipped in the mean
  DeviceMeans(const Device& device, const SaturationLevels& levels);

  /// Adds a frame of the size of the others. It has been copied when this returns.
  void add(const RawView& raw);
  /// Starts to make the mean of the frames added since the last one.
  /// @param averaged  of how many measurements the numbers of one are the mean
  void finish(double averaged);
  /// The next frame is the first.
  void forget() { frames_ = 0; }

  /// The mean, rounded to floats.
  const DeviceRaw& result() const { return result_; }
  /// The mean at some pixels, K each, not rounded. @param pixels  of the frame
  std::vector<double> numbers_of(const std::vector<std::int32_t>& pixels);
  /// The same of all, one measurement after another.
  std::vector<double> numbers() const;
  const DeviceQueue& queue() const { return queue_; }

 private:
  DeviceQueue queue_;
  DeviceKernel add_to_sums_, write_means_, gather_means_;
  SaturationLevels levels_;
  /// What a mean is made of.
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

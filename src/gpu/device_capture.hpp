// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string_view>
#include <vector>

#include "gpu/capture_parameters.h"
#include "gpu/device_queue.hpp"
#include "simulate/shared/row_capture.hpp"

namespace tofsmith {

/// decode_parameters.h, numbers.cl, random.cl, capture_parameters.h and capture.cl, one behind the
/// other.
extern const std::string_view capture_kernels;

struct DeviceCapture::Plan {
  Plan(const Device& device_, const DeviceOptions& options_);

  /// Exposes pixels on the device, and those that it leaves open here.
  /// @return how many these were
  std::int64_t expose(const UnexposedFrames& frames, const Progress& progress);

  Device device;
  DeviceOptions options;
  double margin = 1.0;  ///< times the bounds on what functions of the device may differ by

 private:
  struct Part {
    std::int64_t first = 0, count = 0;
  };
  void set_parameters(const UnexposedFrames& frames, const PixelCapture& pixel);
  void bring_tables(const PixelCapture& pixel);
  void bring_light(const UnexposedFrames& frames, const Part& part);
  std::int64_t expose_part(const UnexposedFrames& frames, int frame, const Part& part);
  std::int64_t bytes_per_pixel(const UnexposedFrames& frames) const;
  DeviceMemory* bring(DeviceMemory& memory, const void* from, std::size_t bytes) const;
  void release();

  std::mutex mutex_;
  DeviceQueue queue_;
  DeviceKernel capture_;
  CaptureParameters parameters_{};
  std::int64_t part_pixels_ = 0;  // at most, once memory was short; 0: not known
  DeviceMemory chi_, exposure_, ambient_gain_, rows_;
  DeviceMemory depth_, albedo_, cosine_, ambient_scale_, collected_, ambient_;
  DeviceMemory sums_, raw_, opened_, open_;
};

}  // namespace tofsmith

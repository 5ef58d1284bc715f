// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gpu/device_means.hpp"

namespace tofsmith {

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

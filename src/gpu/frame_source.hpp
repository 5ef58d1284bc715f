// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gpu/device_means.hpp"

namespace tofsmith {

/// A frame to be filtered or decoded: numbers of this computer, or of the device.
struct FrameSource {
  RawView raw;                           ///< of a frame on the device its size alone
  const DeviceRaw* on_device = nullptr;  ///< all of it
  const DeviceQueue* queue = nullptr;    ///< whose work writes it
  DeviceMeans* means = nullptr;          ///< of which that has the numbers, rounded

  std::int64_t pixels() const { return raw.pixels(); }
  /// Has pixels first .. first + count - 1 in `to`. What is on the device is copied there once its
  /// work is done, and changes after that.
  void bring(const DeviceQueue& to_queue, DeviceRaw& to, std::int64_t first,
             std::int64_t count) const {
    if (!on_device) return to.upload(to_queue, raw, first, count);
    to_queue.follow(queue->mark());
    to.copy(to_queue, *on_device, raw.measurements, first, count);
    queue->follow(to_queue.mark());
  }
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gpu/device_means.hpp"

namespace tofsmith {

/// A frame to be filtered or decoded: numbers of this computer, or of the device.
struct FrameSource {
  RawView raw;                           ///< of a frame on the device its size alone
  const DeviceRaw* on_device = nullptr;  ///< all of it, means all; its work there is done
  DeviceMeans* means = nullptr;          ///< of which that has the numbers, rounded

  std::int64_t pixels() const { return raw.pixels(); }
  /// Has pixels first .. first + count - 1 in `to`.
  void bring(const DeviceQueue& queue, DeviceRaw& to, std::int64_t first,
             std::int64_t count) const {
    if (on_device)
      to.copy(queue, *on_device, raw.measurements, first, count);
    else
      to.upload(queue, raw, first, count);
  }
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/core/error.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// The device. @param work  that it is for
/// @throws std::invalid_argument if it has no doubles
inline const Device& with_doubles(const Device& device, const std::string& work) {
  require(device.info().has_doubles, "device", device.info().name, "must have doubles for " + work);
  return device;
}

/// The first GPU, if it has doubles.
inline std::optional<Device> gpu_with_doubles() {
  std::optional<Device> gpu = Device::first_gpu();
  if (gpu && !gpu->info().has_doubles) gpu.reset();
  return gpu;
}

}  // namespace tofsmith

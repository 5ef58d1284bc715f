// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// Returns the device that `auto` uses, or nothing.
using DeviceFinder = std::function<std::optional<Device>()>;

/// Returns the backend for `auto`: the CPU for frames without a spatial filter or below
/// auto_min_pixels_to_filter, else the device, which is looked up when first needed.
/// @param decoder  must use DecodeMethod::zncc
std::unique_ptr<FrameBackend> automatic_backend(DeviceFinder find_device,
                                                std::unique_ptr<const DepthDecoder> decoder,
                                                const DeviceOptions& options);

}  // namespace tofsmith

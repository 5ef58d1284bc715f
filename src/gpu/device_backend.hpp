// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// Returns the backend of a device. @param decoder  of DecodeMethod::zncc
/// @param is_automatic  frames without a spatial filter, or below auto_min_pixels_to_filter, are
///                      processed by the CPU
std::unique_ptr<FrameBackend> device_backend(const Device& device,
                                             std::unique_ptr<const DepthDecoder> decoder,
                                             const DeviceOptions& options, bool is_automatic);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Any decoder as a simulation sees it: positions in [0, N) of many pixels, from their raw
/// measurements (pixels, K). Called from several threads at once.
using DepthEstimator =
    std::function<void(const float* measurements, std::int64_t pixels, double* depth_bin)>;

/// Zero-mean normalized cross-correlation, refined between bins: Decoder::decode_depth_bins.
DepthEstimator correlation_estimator(const ForwardModel& model, const Camera& camera);

}  // namespace tofsmith

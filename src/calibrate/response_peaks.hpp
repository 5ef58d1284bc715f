// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// Peaks of a response, the highest first: each at least 15 % of the highest and 5 `noise_rms`,
/// with a valley below 70 % of its height between it and every higher one.
std::vector<ResponsePeak> peaks_of(const ImpulseResponse& response, double noise_rms);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/depth_trials.hpp"

namespace tofsmith {

/// Depth errors at every point of the trials, and their means; bounds are left at 0.
/// @param code  the one the trials are of
DepthErrorReport trial_errors(const DepthTrials& trials, const CodeSet& code, double bin_m,
                              const EvaluateOptions& options, const Progress& progress);

}  // namespace tofsmith

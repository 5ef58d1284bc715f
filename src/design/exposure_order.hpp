// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/candidate.hpp"

namespace tofsmith {

/// Finds the order of exposures with the smallest rms error of a moving surface, MotionBias. Tries
/// all orders for up to eight exposures, and otherwise exchanges pairs. Exposures with the same
/// modulation remain adjacent, because calibration and lists of the camera refer to frequencies.
/// Keeps the order if the camera lists values for individual exposures, or if neighbouring
/// exposures differ in sensitivity.
ExposureOrder best_exposure_order(const CodeSet& code, const Camera& camera,
                                  double velocity_m_per_s);

/// Reorders the exposures of a candidate if the camera has operating.velocity_m_per_s.
void choose_exposure_order(const Camera& camera, Candidate& candidate);

}  // namespace tofsmith

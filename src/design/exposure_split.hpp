// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/candidate.hpp"
#include "tofsmith/design/design.hpp"

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

/// Chooses exposure shares for the waveforms of a code: the shares with the smallest Cramer-Rao
/// bound (ExposureBound), shares between these and equal ones, or shares from gradients of the soft
/// decoder's error, whichever has the smallest error in few trials.
/// @return the code, with exposure_shares() if new trials confirm a smaller error
CodeSet with_split_exposures(const CodeSet& code, const Camera& camera,
                             const DesignOptions& options);

/// Adds a copy with exposures of different length for each optimized and factorized code of several
/// exposures, and removes codes with exposure shares that are not better, in new trials, than the
/// best code of the same name with equal shares. The messages of the others contain the gain.
/// Does nothing for cameras that list times.
void add_split_exposures(const Camera& camera, const DesignOptions& options, DesignResult& result,
                         const Progress& progress);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/design.hpp"

namespace tofsmith {

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Moves integration time between the exposures in steps of 30, 10 and 3 %, and keeps the moves for
/// which few trials find a smaller error.
/// @return the code, with exposure_shares() if the error decreased
CodeSet with_split_exposures(const CodeSet& code, const Camera& camera,
                             const DesignOptions& options);

/// Adds a copy with exposures of different length for each optimized and factorized code of several
/// exposures; judge_candidates() keeps the better one of equal names. Does nothing for cameras that
/// list times.
void add_split_exposures(const Camera& camera, const DesignOptions& options, DesignResult& result,
                         const Progress& progress);

}  // namespace tofsmith

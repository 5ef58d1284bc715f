// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Moves integration time between the exposures of a code as long as few trials find a smaller
/// error by it, in steps of 30, 10 and 3 % of the time of an exposure.
/// @return the code, with exposure_shares() if that is better
CodeSet with_split_exposures(const CodeSet& code, const Camera& camera,
                             const DesignOptions& options);

/// Adds a copy of each optimized and factorized code of several exposures with split exposures,
/// under the same name: the judge keeps the better one. Nothing on cameras that list times.
void add_split_exposures(const Camera& camera, const DesignOptions& options, DesignResult& result,
                         const Progress& progress);

}  // namespace tofsmith

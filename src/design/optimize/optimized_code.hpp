// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/baselines.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns DesignOptions::exposures or, if empty, the three numbers with the best atlas codes;
/// without them or with operating multipath, suggested_exposures().
std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options,
                                       const Contenders& atlas);

std::string optimized_name(int exposures);

/// @throws std::invalid_argument as optimize(); Interrupted
std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts,
                                            const Progress& progress);

}  // namespace tofsmith

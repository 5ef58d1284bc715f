// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/baselines.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the numbers of exposures to search: DesignOptions::exposures or, if empty, the three
/// numbers with the best atlas codes. Without atlas codes, or with operating multipath, returns
/// suggested_exposures().
std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options,
                                       const Contenders& atlas);

std::string optimized_name(int exposures);

/// Returns the candidates of optimize(), with all matching starts.
/// @throws std::invalid_argument as optimize(); Interrupted
std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts,
                                            const Progress& progress);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/baselines.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the listed numbers of exposures; else the three with the best codes in the atlas;
/// without such codes, or with multipath, the suggested ones.
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

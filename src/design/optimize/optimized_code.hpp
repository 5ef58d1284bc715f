// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Numbers of exposures to optimize for: those asked for, else those that suit the camera.
std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options);

/// "optimized-k5"
std::string optimized_name(int exposures);

/// What optimize() makes of so many exposures, from those of the starts that have as many.
/// @throws std::invalid_argument as optimize(); Interrupted
std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts,
                                            const Progress& progress);

}  // namespace tofsmith

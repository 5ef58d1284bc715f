// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns why there is nothing to search on the camera's chip clock, or nothing if there is: the
/// camera has no chip clock, or too few taps for the default numbers of exposures.
std::optional<BrokenRule> why_nothing_to_search(const Camera& camera, const DesignOptions& options);

/// Returns the numbers of exposures to search: those in the options, or else the suggested ones.
std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options);

/// Returns a name such as "searched-k2".
std::string searched_name(int exposures);

/// Searches the best codes for this number of exposures on the camera's chip clock, by their
/// metric. The result is proven if the search was exhaustive.
/// @return empty if every code is ambiguous
/// @throws std::invalid_argument as search_chip_codes(); Interrupted
std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith

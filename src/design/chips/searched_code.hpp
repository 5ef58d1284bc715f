// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Why there is nothing to search on the camera's chip clock: it has none, or too few taps for the
/// numbers of exposures that are searched where none are listed.
std::optional<BrokenRule> why_nothing_to_search(const Camera& camera, const DesignOptions& options);

/// Numbers of exposures to search codes of: those listed, else those that suit the camera.
std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options);

/// "searched-k2"
std::string searched_name(int exposures);

/// The best codes of so many exposures on the camera's chip clock by their metric, with proof where
/// all codes could be searched.
/// @return none if no code tells all depths apart
/// @throws std::invalid_argument as search_chip_codes(); Interrupted
std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith

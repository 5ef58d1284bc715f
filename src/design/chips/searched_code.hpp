// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

std::optional<BrokenRule> why_nothing_to_search(const Camera& camera, const DesignOptions& options);

std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options);

std::string searched_name(int exposures);

/// Searches the codes with the best metric; empty if every code is ambiguous.
/// @throws std::invalid_argument as search_chip_codes(); Interrupted
std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith

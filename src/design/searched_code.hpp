// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Numbers of exposures to search codes of on the camera's chip clock; none where all methods are
/// asked for and the camera has no such clock.
/// @throws std::invalid_argument if the search is asked for and the camera has no chip clock
std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options);

/// "searched-k2"
std::string searched_name(int exposures);

/// The best code of so many exposures on the camera's chip clock, with proof where all codes could
/// be searched; not judged yet.
/// @throws std::invalid_argument as search_chip_codes(), or if it finds no code; Interrupted
Candidate searched_candidate(const Camera& camera, int exposures, const DesignOptions& options,
                             const Progress& progress);

}  // namespace tofsmith

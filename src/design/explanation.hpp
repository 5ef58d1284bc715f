// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Why the winner won, in three sentences: by how much and over what; what band and taps have to
/// do with its number of exposures; what limits it in little and in much light.
/// @param exposures  requested numbers of exposures; empty: any
std::vector<std::string> explain(const Camera& camera, const DesignResult& result,
                                 const std::vector<int>& exposures = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Explains the winner: its lead, its number of exposures, and the limits of its error in dim and
/// in bright light.
/// @param exposures  requested numbers; empty: any
std::vector<std::string> explain(const Camera& camera, const DesignResult& result,
                                 const std::vector<int>& exposures = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith::apps {

/// What `--perturb jitter=50ps,clock=5ns,droop=3%` says: these changes, each alone and all
/// together, and no other.
/// @throws UsageError naming the word, what was found and what was expected
RobustnessOptions parse_perturbations(std::string_view text);

}  // namespace tofsmith::apps

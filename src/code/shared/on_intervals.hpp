// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Sorts intervals, moved by whole periods to rise in [0, 1). Overlaps and intervals within
/// rounding are removed.
std::vector<OnInterval> within_period(std::vector<OnInterval> on);

/// Multiplies the length of every interval by `factor`, about its centre, and merges overlaps;
/// intervals that cover the period become {[0, 1)}.
/// @param on  not empty
std::vector<OnInterval> stretched(const std::vector<OnInterval>& on, double factor);

}  // namespace tofsmith

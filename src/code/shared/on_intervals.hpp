// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Sorts intervals, moved by whole periods to rise in [0, 1). Overlaps and intervals within
/// rounding are removed.
std::vector<OnInterval> within_period(std::vector<OnInterval> on);

/// Multiplies the length of every interval by `factor`, about its centre, and merges overlaps;
/// intervals that cover the period become {[0, 1)}.
/// @param on  not empty
std::vector<OnInterval> stretched(const std::vector<OnInterval>& on, double factor);

/// Gated ramp: a rising gain in the first exposure, a constant gain in the second to measure the
/// signal, and no light in the third to measure ambient light. K = 3.
CodeSet single_ramp_code(const FamilyOptions& options);

/// A rising and a falling ramp, whose ratio determines depth, and an exposure without light. K = 3.
CodeSet double_ramp_code(const FamilyOptions& options);

}  // namespace tofsmith

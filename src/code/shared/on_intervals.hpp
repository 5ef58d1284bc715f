// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Moves intervals by whole periods so that each rises in [0, 1), and sorts them. An interval that
/// overlaps the next one by rounding is cut; intervals shorter than rounding are removed.
std::vector<OnInterval> within_period(std::vector<OnInterval> on);

/// Multiplies the length of every interval by `factor`, about its centre. Resulting overlaps are
/// merged; intervals that cover the period become {[0, 1)}.
/// @param on  not empty
std::vector<OnInterval> stretched(const std::vector<OnInterval>& on, double factor);

}  // namespace tofsmith

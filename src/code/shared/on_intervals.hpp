// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Moves intervals by whole periods so that each rises in [0, 1), and sorts them. Where rounding
/// makes an interval overlap the next one, it ends there; intervals shorter than rounding vanish.
std::vector<OnInterval> within_period(std::vector<OnInterval> on);

/// Multiplies the length of every interval by `factor`, about its centre. Intervals that then
/// overlap or touch are merged; intervals that cover the period become {[0, 1)}.
/// @param on  not empty, as in a valid waveform
std::vector<OnInterval> stretched(const std::vector<OnInterval>& on, double factor);

}  // namespace tofsmith

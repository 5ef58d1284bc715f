// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tofsmith/report/page.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::apps {

/// Returns a sweep as a page: its progress, a figure for every numeric axis, a map for every pair
/// of numeric axes, and a table of all errors.
Page sweep_page(const WorkList& list, std::span<const SweepResult> results,
                const SweepCounts& counts, const std::string& command_line);

}  // namespace tofsmith::apps

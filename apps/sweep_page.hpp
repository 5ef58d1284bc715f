// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tofsmith/report/page.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith::apps {

/// A sweep as a page: how far it is, a figure for every axis of numbers, a map for every two axes,
/// a table of all errors.
Page sweep_page(const WorkList& list, std::span<const SweepResult> results,
                const SweepCounts& counts, const std::string& command_line);

}  // namespace tofsmith::apps

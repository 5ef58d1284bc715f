// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/table_reader.hpp"
#include "tofsmith/sweep/sweep_spec.hpp"

namespace tofsmith {

/// Most values that one axis may have.
inline constexpr std::int64_t max_axis_values = 1'000'000;

/// Reads one [[axis]]. @throws IoError naming file:line:column
SweepAxis read_sweep_axis(TableReader& table);

/// Refuses values that no item could use. @throws IoError naming file:line:column
void check_axis_values(const SweepAxis& axis);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Mean circular depth error [m] of a table on frames made from itself, so that measured tables
/// stand beside codes: expected electrons along the chords between its rows, normal noise of the
/// variance it states, one depth drawn in each of `trials` equal slices of the range.
/// @param light   S in multiples of what the table was measured with, A in e/s
/// @param trials  >= 2; odd numbers are rounded up
/// @throws std::invalid_argument if the table or the number of trials is invalid
/// @note same bits for any number of threads, on one dispatch_target()
Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials = 20000, std::uint64_t seed = 1);

}  // namespace tofsmith

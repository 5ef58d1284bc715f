// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Title of the column of exposures_by_taps().
inline constexpr const char* exposures_by_taps_title = "exposures x taps";

/// Explanation of the terms in tables of depth errors.
inline constexpr const char* depth_error_legend =
    "taps: values that are read out per exposure; linear: error of the depth; circular: error "
    "modulo the unambiguous range; S, A: signal and ambient light";

/// Returns the number of exposures and of values per exposure, such as "3 x 2"; "3 x 1" if the
/// sensor delivers the difference of two taps.
std::string exposures_by_taps(const DepthErrorReport& error);

}  // namespace tofsmith

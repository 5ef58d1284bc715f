// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Resolution of a common divisor [Hz].
inline constexpr double common_frequency_resolution_hz = 10.0;

/// Greatest common divisor [Hz], by Euclid's algorithm on real numbers; none below the resolution.
std::optional<double> common_frequency_hz(std::span<const double> frequencies_hz);

}  // namespace tofsmith

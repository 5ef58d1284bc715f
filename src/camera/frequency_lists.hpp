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

/// @throws InvalidArgument for an empty list or a repeated value
template <typename Number>
void require_distinct(const std::string& field, const std::vector<Number>& values) {
  require(!values.empty(), field, "[]", "must list at least one value");
  for (const Number& value : values)
    require(std::count(values.begin(), values.end(), value) == 1, field, value,
            "must be listed once");
}

}  // namespace tofsmith

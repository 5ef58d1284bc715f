// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "tofsmith/report/figure.hpp"

namespace tofsmith::figure_json {

using Json = nlohmann::ordered_json;

/// Six significant digits; null if not finite.
Json number(double value);
Json numbers(std::span<const double> values);

/// A large array: multiples of a step as 16-bit words, deflated, in base64:
/// {"count", "low", "step", "row", "words"}. A value is (word - 1 + low) * step; word 0 is NaN.
/// Each word is stored as its difference from its predecessor in a row of `row` values.
/// @param resolution  smallest difference that a reader can see; 0: the range over 65000
Json packed(std::span<const float> values, std::size_t row, double resolution = 0.0);

Json axis(const Axis& axis);

/// @throws std::invalid_argument if the scale is invalid
Json colours(const ColourScale& scale);

/// Difference of values that a colour scale can show: 1/512 of its range, 0 for logarithmic ones.
double resolution_of(const ColourScale& scale, std::span<const float> values);

}  // namespace tofsmith::figure_json

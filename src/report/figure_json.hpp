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

/// Encodes a large array as 16-bit words, deflated, in base64: {"count", "low", "step", "row",
/// "words"}. A value is (word - 1 + low) * step; word 0 is NaN. Each word is stored as the
/// difference from its predecessor in a row of `row` values.
/// @param resolution  smallest visible difference; 0: range / 65000
Json packed(std::span<const float> values, std::size_t row, double resolution = 0.0);

Json axis(const Axis& axis);

/// @throws std::invalid_argument if the scale is invalid
Json colours(const ColourScale& scale);

/// Smallest visible difference: 1/512 of the range, 0 if logarithmic.
double resolution_of(const ColourScale& scale, std::span<const float> values);

}  // namespace tofsmith::figure_json

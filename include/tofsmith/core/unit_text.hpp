// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tofsmith {

/// Reads a number with optional unit, such as "20MHz", "5 mm" or "2".
/// @param unit  as returned by unit_of_key(); also the unit of a number without one
/// @return the number in `unit`; none if the text is not a number or its unit is of another kind
std::optional<double> number_in_unit(std::string_view text, std::string_view unit);

/// Returns "a number, or one with its unit such as 2MHz", or "a number" without a unit.
std::string number_rule(std::string_view unit);

}  // namespace tofsmith

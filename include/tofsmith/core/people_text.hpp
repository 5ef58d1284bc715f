// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

/// A number for people: rounded to so many significant digits, at least to a whole number, and
/// never a power of ten: "61.23", "0.0123", "175312". "nan", "inf" as they are.
std::string plain_number(double value, int digits);

/// A length in the unit that suits it: "0.0653" -> "65.3 mm", "1.25" -> "1.25 m".
std::string length_text(double metres);

/// "61.23 ± 0.45" of value / unit, with one standard error.
std::string estimate_text(const Estimate& estimate, double unit, int digits = 5);

/// An error in mm and its standard error.
std::string estimate_mm_text(const Estimate& error_m);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string_view>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

inline void require_positive(double value, std::string_view field) {
  require(std::isfinite(value) && value > 0.0, field, value, "must be finite and > 0");
}

inline void require_not_negative(double value, std::string_view field) {
  require(std::isfinite(value) && value >= 0.0, field, value, "must be finite and >= 0");
}

}  // namespace tofsmith

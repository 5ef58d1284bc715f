// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/range.hpp"

#include <fmt/format.h>

namespace tofsmith {

std::string Range::text(bool is_integer) const {
  if (!is_restricted) return "a number";
  if (std::isfinite(high))
    return fmt::format("in {}{}, {}{}", includes_low ? '[' : '(', low, high,
                       includes_high ? ']' : ')');
  if (!std::isfinite(low)) return "finite";
  return fmt::format("{}{} {}", is_integer || includes_infinity ? "" : "finite and ",
                     includes_low ? ">=" : ">", low);
}

}  // namespace tofsmith

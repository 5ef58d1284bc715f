// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/second_returns.hpp"

#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void SecondReturns::validate(double range_m) const {
  require(least_ratio >= 0.0 && least_ratio <= 1.0, "SecondReturns::least_ratio", least_ratio,
          "must be in [0, 1]");
  require(largest_ratio >= least_ratio && largest_ratio <= 1.0, "SecondReturns::largest_ratio",
          largest_ratio, "must be in [least_ratio, 1]");
  require(shortest_delay_m > 0.0 && shortest_delay_m < range_m, "SecondReturns::shortest_delay_m",
          shortest_delay_m, "must be > 0 and below the range, " + std::to_string(range_m) + " m");
  require(
      longest_delay_m >= shortest_delay_m && longest_delay_m < range_m,
      "SecondReturns::longest_delay_m", longest_delay_m,
      "must be at least shortest_delay_m and below the range, " + std::to_string(range_m) + " m");
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Second returns as a camera meets them: ratio and delay are uniform between their limits.
struct SecondReturns {
  double least_ratio = 0.1, largest_ratio = 0.5;         ///< r = S2 / S1, in [0, 1]
  double shortest_delay_m = 0.5, longest_delay_m = 3.0;  ///< behind the direct return, > 0 [m]

  /// A ratio and a delay from two numbers uniform on [0, 1).
  double ratio(double uniform) const {
    return least_ratio + uniform * (largest_ratio - least_ratio);
  }
  double delay_m(double uniform) const {
    return shortest_delay_m + uniform * (longest_delay_m - shortest_delay_m);
  }

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};

}  // namespace tofsmith

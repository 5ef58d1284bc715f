// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace tofsmith {

/// Second returns as a camera meets them: ratio and delay are uniform between their limits. Field
/// names are the keys of [operating.multipath] in the TOML file.
struct SecondReturns {
  std::array<double, 2> ratio{0.1, 0.5};    ///< r = S2 / S1, least and largest, in [0, 1]
  std::array<double, 2> delay_m{0.5, 3.0};  ///< behind the direct return, in (0, range) [m]
  /// How much they count where codes are designed: what is minimized is E1^(1 - weight) E2^weight,
  /// with E1 the error of single returns and E2 that behind such second ones, decoded as
  /// single-path; in (0, 1).
  double weight = 0.2;

  /// A ratio and a delay from two numbers uniform on [0, 1).
  double ratio_at(double uniform) const { return ratio[0] + uniform * (ratio[1] - ratio[0]); }
  double delay_at_m(double uniform) const {
    return delay_m[0] + uniform * (delay_m[1] - delay_m[0]);
  }

  /// E1^(1 - weight) E2^weight.
  double weighed(double single_return_error, double second_return_error) const;

  /// @throws std::invalid_argument naming the field as operating.multipath.*, value and rule
  void validate(double range_m) const;

  friend bool operator==(const SecondReturns&, const SecondReturns&) = default;
};

}  // namespace tofsmith

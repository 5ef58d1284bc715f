// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// How far two-return decoding of a code may err: a little farther than of the best code given.
class TwoReturnLimit {
 public:
  /// @param most_loss  OptimizeOptions::most_two_return_loss
  explicit TwoReturnLimit(double most_loss) : most_loss_(most_loss) {}

  void add_given(const std::optional<SecondReturnReport>& report) {
    if (report && report->two_return)
      least_m_ = std::min(least_m_, report->two_return->circular_m.value);
  }
  /// How many times worse a code counts: as often as it is over the limit, 1 within it, and no more
  /// than 1.25, also if it cannot be decoded as two returns. 1 for all if no code given can.
  double excess(const std::optional<SecondReturnReport>& report) const {
    if (!report || std::isinf(least_m_)) return 1.0;
    constexpr double most_excess = 1.25;
    if (!report->two_return) return most_excess;
    return std::clamp(report->two_return->circular_m.value / (most_loss_ * least_m_), 1.0,
                      most_excess);
  }

 private:
  double most_loss_;
  double least_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace tofsmith

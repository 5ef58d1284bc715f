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
  /// @param max_loss  OptimizeOptions::max_two_return_loss
  explicit TwoReturnLimit(double max_loss) : max_loss_(max_loss) {}

  void add_given(const std::optional<OperatingMultipathReport>& report) {
    if (report && report->two_return)
      min_m_ = std::min(min_m_, report->two_return->circular_m.value);
  }
  /// How many times worse a code counts: as often as it is over the limit, 1 within it, and no more
  /// than 1.25, also if it cannot be decoded as two returns. 1 for all if no code given can.
  double excess(const std::optional<OperatingMultipathReport>& report) const {
    if (!report || std::isinf(min_m_)) return 1.0;
    constexpr double max_excess = 1.25;
    if (!report->two_return) return max_excess;
    return std::clamp(report->two_return->circular_m.value / (max_loss_ * min_m_), 1.0, max_excess);
  }

 private:
  double max_loss_;
  double min_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace tofsmith

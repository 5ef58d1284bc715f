// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Limit of two-return errors, relative to the best initial code.
class TwoReturnLimit {
 public:
  explicit TwoReturnLimit(double max_loss) : max_loss_(max_loss) {}

  void add_given(const std::optional<OperatingMultipathReport>& report) {
    if (report && report->two_return)
      min_m_ = std::min(min_m_, report->two_return->circular_m.value);
  }
  /// Returns a factor on the ranking error: two-return error / limit, clipped to [1, 1.25]; 1.25 if
  /// two returns cannot be decoded; 1 if this is true of all initial codes.
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

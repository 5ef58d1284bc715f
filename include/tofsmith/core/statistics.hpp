// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// A value and its standard error.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
};
/// a / b of independent estimates.
Estimate ratio_of(const Estimate& a, const Estimate& b);

/// Mean and variance in one pass (Welford).
class RunningStatistics {
 public:
  void add(double value);

  std::int64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased; 0 for fewer than two values.
  double variance() const;
  /// Standard error of mean(); 0 for fewer than two values.
  double standard_error() const;
  Estimate estimate() const { return {mean(), standard_error()}; }

 private:
  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double sum_of_squares_ = 0.0;  // of differences from the mean
};

/// Mean of the middle two for an even number; 0 if empty.
double median_of(std::vector<double> values);

/// Returns the value at index floor(share (n - 1)) in ascending order.
/// @param values  not empty
/// @param share   in [0, 1]
double quantile_of(std::vector<double> values, double share);

/// Arithmetic mean of independent estimates.
Estimate mean_of(std::span<const Estimate> estimates);

/// Geometric mean of independent positive estimates, with first-order error propagation. 0 if a
/// value is 0, NaN if one is NaN.
Estimate geometric_mean_of(std::span<const Estimate> estimates);

}  // namespace tofsmith

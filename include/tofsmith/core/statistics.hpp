// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// A figure and the standard deviation of its own uncertainty.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
};
/// a / b; the standard error takes the two for independent.
Estimate ratio_of(const Estimate& a, const Estimate& b);

/// Mean and variance of a stream of values in one pass (Welford).
class RunningStatistics {
 public:
  void add(double value);

  std::int64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased sample variance; 0 below two values.
  double variance() const;
  /// Standard deviation of mean() as an estimate of the true mean; 0 below two values.
  double standard_error() const;
  Estimate estimate() const { return {mean(), standard_error()}; }

 private:
  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double sum_of_squares_ = 0.0;  // of differences from the mean
};

/// The middle value, or the mean of the middle two; 0 of none.
double median_of(std::vector<double> values);

/// Arithmetic mean of independent estimates, errors propagated.
Estimate mean_of(std::span<const Estimate> estimates);

/// Geometric mean of independent positive estimates, errors propagated to first order.
/// A value of exactly 0 makes the mean 0; one that is not a number makes it not a number.
Estimate geometric_mean_of(std::span<const Estimate> estimates);

}  // namespace tofsmith

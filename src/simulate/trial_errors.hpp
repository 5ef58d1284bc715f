// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/depth_trials.hpp"

namespace tofsmith {

/// Sums over pairs of trials in neighbouring slices, for means and mean squares with variances
/// (collapsed strata).
struct ErrorSums {
  TileSums sums;
  std::int64_t trials = 0;

  void merge(const ErrorSums& other);
  Estimate linear(double bin_m) const;
  Estimate circular(double bin_m) const;
  Estimate linear_rms(double bin_m) const;
  Estimate circular_rms(double bin_m) const;
  Estimate outlier_rate() const;
};

/// Outliers are circular errors beyond the threshold.
std::vector<ErrorSums> sum_errors(const DepthTrials& trials, std::span<const TrialRound> rounds,
                                  double threshold_bin, const Progress& progress);

template <typename Point>
DepthErrorMean mean_over_points(const std::vector<Point>& points, Estimate Point::*error) {
  std::vector<Estimate> errors;
  for (const Point& point : points) errors.push_back(point.*error);
  return {geometric_mean_of(errors), mean_of(errors)};
}

/// Returns depth errors without bounds.
/// @param code, camera  of the trials
DepthErrorReport trial_errors(const DepthTrials& trials, const CodeSet& code, const Camera& camera,
                              const EvaluateOptions& options, const Progress& progress);

}  // namespace tofsmith

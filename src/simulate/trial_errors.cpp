// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/trial_errors.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {

/// Sum of values whose order follows depth, and of the squared differences of neighbours in pairs:
/// the variance of a mean over slices of depth (collapsed strata).
class SlicedSum {
 public:
  void add_pair(double first, double second) {
    sum_ += first + second;
    squared_differences_ += (first - second) * (first - second);
  }
  void merge(const SlicedSum& other) {
    sum_ += other.sum_;
    squared_differences_ += other.squared_differences_;
  }
  Estimate mean(std::int64_t count, double scale = 1.0) const {
    const double per_value = scale / static_cast<double>(count);
    return {sum_ * per_value, std::sqrt(squared_differences_) * per_value};
  }

 private:
  double sum_ = 0.0;
  double squared_differences_ = 0.0;
};

struct ErrorSums {
  SlicedSum linear, circular, outliers;

  void merge(const ErrorSums& other) {
    linear.merge(other.linear);
    circular.merge(other.circular);
    outliers.merge(other.outliers);
  }
};

ErrorSums errors_of(const TrialBlock& trials, double samples, double threshold_bin) {
  ErrorSums sums;
  const auto linear = [&](std::size_t t) {
    return std::abs(trials.decoded_bin[t] - trials.true_bin[t]);
  };
  for (std::size_t t = 0; t + 1 < trials.true_bin.size(); t += 2) {
    const double a = linear(t), b = linear(t + 1);
    const double circular_a = std::min(a, samples - a), circular_b = std::min(b, samples - b);
    sums.linear.add_pair(a, b);
    sums.circular.add_pair(circular_a, circular_b);
    sums.outliers.add_pair(circular_a > threshold_bin, circular_b > threshold_bin);
  }
  return sums;
}

/// Blocks are summed in their order, whichever thread made them.
ErrorSums sum_errors(const DepthTrials& trials, std::size_t point, double threshold_bin,
                     const Progress& progress) {
  std::vector<ErrorSums> of_block(static_cast<std::size_t>(trials.blocks()));
  trials.run(
      point,
      [&](const TrialBlock& block) {
        of_block[static_cast<std::size_t>(block.block)] =
            errors_of(block, trials.samples(), threshold_bin);
      },
      progress);
  ErrorSums total;
  for (const ErrorSums& sums : of_block) total.merge(sums);
  return total;
}

DepthErrorMean mean_over_points(const std::vector<PointDepthError>& points,
                                Estimate PointDepthError::*error) {
  std::vector<Estimate> errors;
  for (const PointDepthError& point : points) errors.push_back(point.*error);
  return {geometric_mean_of(errors), mean_of(errors)};
}

Progress part_for(const Progress& progress, std::size_t point, std::size_t points) {
  const auto count = static_cast<double>(points);
  return part_of(progress, static_cast<double>(point) / count,
                 static_cast<double>(point + 1) / count);
}

}  // namespace

DepthErrorReport trial_errors(const DepthTrials& trials, const CodeSet& code, double bin_m,
                              const EvaluateOptions& options, const Progress& progress) {
  DepthErrorReport result;
  result.code = code.name();
  result.exposures = code.exposures();
  result.taps = code.taps();
  result.measurements = trials.measurements();
  result.samples = code.samples();
  result.trials = trials.trials();
  result.seed = options.seed;
  result.outlier_threshold_m = options.outlier_threshold_m;

  for (std::size_t p = 0; p < trials.points().size(); ++p) {
    const ErrorSums sums = sum_errors(trials, p, options.outlier_threshold_m / bin_m,
                                      part_for(progress, p, trials.points().size()));
    PointDepthError error;
    error.point = trials.points()[p];
    error.linear_mde_m = sums.linear.mean(trials.trials(), bin_m);
    error.circular_mde_m = sums.circular.mean(trials.trials(), bin_m);
    error.outlier_rate = sums.outliers.mean(trials.trials());
    result.points.push_back(error);
  }
  result.linear = mean_over_points(result.points, &PointDepthError::linear_mde_m);
  result.circular = mean_over_points(result.points, &PointDepthError::circular_mde_m);
  return result;
}

}  // namespace tofsmith

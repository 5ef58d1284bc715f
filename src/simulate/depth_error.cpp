// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/depth_trials.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/simulate/bounds.hpp"

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

void EvaluateOptions::validate() const {
  require(trials >= 2 && trials <= 4'000'000'000, "trials", trials, "must be in [2, 4e9]");
  require(outlier_threshold_m >= 0.0, "outlier_threshold_m", outlier_threshold_m, "must be >= 0");
}

DepthErrorReport evaluate(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                          const Progress& progress) {
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera, options);
  const CramerRaoBound cramer_rao(model, camera);
  const ReceiverBound receiver(camera, code.exposures());

  DepthErrorReport result;
  result.code = code.name();
  result.exposures = code.exposures();
  result.taps = code.taps();
  result.measurements = model.measurements();
  result.samples = code.samples();
  result.trials = trials.trials();
  result.seed = options.seed;
  result.outlier_threshold_m = options.outlier_threshold_m;

  const double bin_m = camera.bin_m();
  for (std::size_t p = 0; p < trials.points().size(); ++p) {
    const ErrorSums sums = sum_errors(trials, p, options.outlier_threshold_m / bin_m,
                                      part_for(progress, p, trials.points().size()));
    PointDepthError error;
    error.point = trials.points()[p];
    error.linear_mde_m = sums.linear.mean(trials.trials(), bin_m);
    error.circular_mde_m = sums.circular.mean(trials.trials(), bin_m);
    error.outlier_rate = sums.outliers.mean(trials.trials());
    if (camera.operating.uniform_albedo) {
      error.cramer_rao_mae_m = cramer_rao.mae_uniform_albedo_m(error.point);
      error.receiver_bound_mae_m = receiver.mae_uniform_albedo_m(error.point);
    } else {
      const OperatingPoint seen = {camera.operating.albedo * error.point.signal_e_per_s,
                                   error.point.ambient_e_per_s};
      error.cramer_rao_mae_m = cramer_rao.mae_m(seen);
      error.receiver_bound_mae_m = receiver.mae_m(seen);
    }
    result.points.push_back(error);
  }
  result.linear = mean_over_points(result.points, &PointDepthError::linear_mde_m);
  result.circular = mean_over_points(result.points, &PointDepthError::circular_mde_m);
  report(progress, 1.0, "depth error");
  return result;
}

}  // namespace tofsmith

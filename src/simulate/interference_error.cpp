// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/interference_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "simulate/depth_cells.hpp"
#include "simulate/interference_light.hpp"
#include "simulate/pixel_trials.hpp"
#include "simulate/trial_errors.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Variance of a weighted sum of measurements [e^2], by cause.
struct WeightedNoise {
  double by_signal = 0.0, by_ambient = 0.0;  ///< per e/s
  double floor = 0.0;
};

/// WeightedNoise at the middles of equal cells of the range.
class NoiseOfCells {
 public:
  NoiseOfCells(const ForwardModel& model, Eigen::Index cells) : model_(model) {
    const auto points = static_cast<int>(2 * cells);
    if (model.has_rows())
      of_rows_ = row_covariance(model, points);
    else
      tap_signal_ = model.tap_correlation_table(points) * model.tap_exposure_s().asDiagonal();
    ambient_ = model.tap_ambient_gain().cwiseProduct(model.tap_exposure_s());
    dark_ = model.tap_dark_e_per_s() * model.tap_exposure_s();
    constant_ = model.constant_variance_e2();
  }

  WeightedNoise at(Eigen::Index cell, const Eigen::VectorXd& weights) const {
    const Eigen::Index row = 2 * cell + 1;
    if (of_rows_) {
      const auto variance = [&](double signal_e_per_s, double ambient_e_per_s) {
        return weights.dot(of_rows_->at(row, signal_e_per_s, ambient_e_per_s) * weights);
      };
      const double floor = variance(0.0, 0.0);
      return {variance(1.0, 0.0) - floor, variance(0.0, 1.0) - floor, floor};
    }
    const Eigen::VectorXd square = (model_.readout().transpose() * weights).cwiseAbs2();
    return {tap_signal_.row(row).dot(square), ambient_.dot(square),
            dark_.dot(square) + constant_.dot(weights.cwiseAbs2())};
  }

 private:
  const ForwardModel& model_;
  Eigen::MatrixXd tap_signal_;  // (2 cells, tap values); empty for rows
  Eigen::VectorXd ambient_, dark_, constant_;
  std::optional<RowCovariance> of_rows_;
};

/// First-order errors of zncc, root mean squares over the depths.
class ExpectedErrors {
 public:
  /// @param camera  the camera of `model`
  ExpectedErrors(const ForwardModel& model, const Camera& camera, const InterferenceLight& other);

  /// Without noise [m].
  double interference_rms_m() const { return range_m_ * std::sqrt(interference_); }
  /// With noise [m].
  double rmse_m(const OperatingPoint& point) const;

 private:
  const OperatingRange& operating_;
  double range_m_, other_per_signal_;
  double interference_ = 0.0;  // mean square
  WeightedNoise noise_;        // mean
};

ExpectedErrors::ExpectedErrors(const ForwardModel& model, const Camera& camera,
                               const InterferenceLight& other)
    : operating_(camera.operating), range_m_(camera.range_m()) {
  const OperatingInterference& interference = *operating_.interference;
  other_per_signal_ = interference.cameras * interference.signal_ratio * other.mean() *
                      (camera.temperature ? camera.temperature->signal_gain() : 1.0);

  // Cameras are independent: variances add, and so do means.
  const Eigen::MatrixXd measuring = model.readout() * model.tap_exposure_s().asDiagonal();
  const Eigen::VectorXd mean = other.first_moment(measuring);
  const Eigen::MatrixXd of_mean = mean * mean.transpose();
  const double count = interference.cameras;
  const Eigen::MatrixXd moment =
      interference.signal_ratio * interference.signal_ratio *
      (count * (other.second_moment(measuring) - of_mean) + count * count * of_mean);

  const Eigen::Index cells = default_cells_per_bin(model) * model.samples();
  const NoiseOfCells noise(model, cells);
  for_each_depth_cell(model, camera, cells,
                      [&](Eigen::Index cell, double mass, const auto&, const auto& part) {
                        const Eigen::VectorXd weights = part.across / (part.length * part.length);
                        interference_ += mass * std::max(0.0, weights.dot(moment * weights));
                        const WeightedNoise of_cell = noise.at(cell, weights);
                        noise_.by_signal += mass * of_cell.by_signal;
                        noise_.by_ambient += mass * of_cell.by_ambient;
                        noise_.floor += mass * of_cell.floor;
                      });
}

double ExpectedErrors::rmse_m(const OperatingPoint& point) const {
  if (operating_.uniform_albedo) return std::numeric_limits<double>::infinity();
  const double signal_e_per_s = operating_.albedo * point.signal_e_per_s;
  const double ambient_e_per_s = point.ambient_e_per_s + other_per_signal_ * signal_e_per_s;
  const double noise_e2 =
      signal_e_per_s * noise_.by_signal + ambient_e_per_s * noise_.by_ambient + noise_.floor;
  return range_m_ * std::sqrt(interference_ + noise_e2 / (signal_e_per_s * signal_e_per_s));
}

/// Measures pixels with the light of the other cameras.
std::vector<PixelSums> run_trials(const PixelTrials& trials, const Camera& camera,
                                  const InterferenceLight& other, const Progress& progress) {
  const OperatingInterference& interference = *camera.operating.interference;
  const auto taps = static_cast<std::size_t>(trials.pixel().tap_values());
  const auto draw = [&](RandomStream& random, double quantile, const OperatingPoint& point,
                        float* raw) {
    const auto [depth_m, signal_e_per_s] =
        trials.draw_surface(quantile, point.signal_e_per_s, random);
    std::vector<double> work(taps), light(taps, 0.0);
    for (int i = 0; i < interference.cameras; ++i)
      other.add(interference.signal_ratio * signal_e_per_s, random, light);
    // Short pulses have more harmonics than the table, whose sum can be slightly negative.
    if (!camera.sensor.is_signed())
      for (double& value : light) value = std::max(value, 0.0);
    trials.pixel().add_light(depth_m, signal_e_per_s, work, light);
    trials.pixel().expose(point.ambient_e_per_s, random, light, raw);
    return TrueDepths{depth_m, depth_m};
  };
  return trials.run(0, draw, "interference", progress);
}

}  // namespace

InterferenceReport interference_error(const CodeSet& code, const Camera& on,
                                      const EvaluateOptions& options, const Progress& progress) {
  options.validate();
  require(on.operating.interference.has_value(), "operating.interference", "none",
          "must be given: it describes the other cameras");
  const Camera camera = judged_camera(on);
  const PixelTrials trials(code, camera, options);
  // The exposures of the judged camera are longer, because it adds neighbours.
  const InterferenceLight other(code, on);
  const ExpectedErrors expected(trials.model(), camera, other);
  InterferenceReport result;
  result.rms_m = expected.interference_rms_m();
  const std::vector<PixelSums> sums = run_trials(trials, camera, other, progress);
  const std::vector<OperatingPoint> points = camera.operating.points();
  std::vector<WrongShares> shares;
  for (std::size_t p = 0; p < points.size(); ++p) {
    shares.push_back(sums[p].shares());
    result.points.push_back({.point = points[p],
                             .expected_rmse_m = expected.rmse_m(points[p]),
                             .linear_mde_m = sums[p].linear_m.estimate(),
                             .circular_mde_m = sums[p].circular_m.estimate(),
                             .circular_rmse_m = sums[p].circular_rmse_m(),
                             .shares = shares.back()});
  }
  result.linear = mean_over_points(result.points, &InterferencePoint::linear_mde_m);
  result.circular = mean_over_points(result.points, &InterferencePoint::circular_mde_m);
  result.shares = mean_shares(shares);
  return result;
}

}  // namespace tofsmith

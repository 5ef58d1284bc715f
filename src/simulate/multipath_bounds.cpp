// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <cmath>
#include <limits>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/decompositions.hpp"
#include "core/shared/special_functions.hpp"
#include "simulate/ziv_zakai.hpp"

namespace tofsmith {

namespace {

constexpr int points_per_bin = 8;

/// Length of the part of the first column that is orthogonal to all others.
double length_across(Eigen::MatrixXd columns) {
  const double whole = columns.col(0).norm();
  if (!(whole > 0.0)) return 0.0;
  for (Eigen::Index i = 1; i < columns.cols(); ++i) columns.col(i).stableNormalize();
  const Eigen::MatrixXd others = columns.rightCols(columns.cols() - 1);
  const double left = (columns.col(0) - others * least_squares(others, columns.col(0))).norm();
  return left > 1e-10 * whole ? left : 0.0;
}

}  // namespace

MultipathBound::MultipathBound(const ForwardModel& model, const Camera& camera)
    : samples_((require(!model.has_rows(), "sensor.readout", "rows",
                        "has no two-return bound, which requires independent measurements"),
                model.samples())),
      range_m_(camera.range_m()),
      readout_(model.readout()),
      table_(model.tap_correlation_table(points_per_bin * model.samples()) *
             model.tap_exposure_s().asDiagonal()),
      ambient_(model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera))),
      masses_(DepthPrior(camera).masses(samples_)) {
  const Eigen::MatrixXd sums = readout_.cwiseAbs();
  shot_ambient_ = sums * model.tap_exposure_s().cwiseProduct(model.tap_ambient_gain());
  floor_variance_e2_ =
      model.constant_variance_e2() + sums * (model.tap_dark_e_per_s() * model.tap_exposure_s());
}

Eigen::VectorXd MultipathBound::sigma_of(const OperatingPoint& point, double ratio,
                                         const Eigen::MatrixXd& later, Eigen::Index shift,
                                         bool delay_is_known) const {
  const Eigen::Index points = table_.rows();
  const Eigen::MatrixXd sums = readout_.cwiseAbs();
  const double s1 = point.signal_e_per_s, s2 = ratio * s1;
  const bool sees_ambient = !ambient_.isZero(1e-9 * shot_ambient_.maxCoeff());
  Eigen::VectorXd sigma(samples_);
  for (Eigen::Index n = 0; n < samples_; ++n) {
    const Eigen::Index at = n * points_per_bin + points_per_bin / 2, behind = at + shift;
    const auto row = [&](const Eigen::MatrixXd& table, Eigen::Index j) {
      return Eigen::VectorXd(table.row(((j % points) + points) % points).transpose());
    };
    // Slopes are means over two points, per period.
    const auto slope = [&](const Eigen::MatrixXd& table, Eigen::Index j) {
      return Eigen::VectorXd((row(table, j + 1) - row(table, j - 1)) *
                             (0.5 * static_cast<double>(points)));
    };
    const Eigen::VectorXd light = s1 * row(table_, at) + s2 * row(later, behind);
    const Eigen::VectorXd weight =
        (sums * light + point.ambient_e_per_s * shot_ambient_ + floor_variance_e2_)
            .cwiseMax(1e-9)
            .cwiseSqrt()
            .cwiseInverse();
    Eigen::MatrixXd columns(ambient_.size(), 3);
    const Eigen::VectorXd by_delay = s2 * (readout_ * slope(later, behind));
    columns.col(0) = s1 * (readout_ * slope(table_, at)) + by_delay;
    columns.col(1) = readout_ * row(table_, at);
    columns.col(2) = readout_ * row(later, behind);
    const auto add = [&](const Eigen::VectorXd& column) {
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.rightCols(1) = column;
    };
    if (!delay_is_known && ratio > 0.0) add(by_delay);
    if (sees_ambient) add(ambient_);
    const double across = length_across(weight.asDiagonal() * columns);
    sigma[n] = across > 0.0 ? range_m_ / across : std::numeric_limits<double>::infinity();
  }
  return sigma;
}

Eigen::VectorXd MultipathBound::sigma_m(const OperatingPoint& point, double ratio,
                                        double delay_m) const {
  const auto shift = static_cast<Eigen::Index>(
      std::lround(delay_m / range_m_ * static_cast<double>(table_.rows())));
  return sigma_of(point, ratio, table_, shift, false);
}

Eigen::VectorXd MultipathBound::tail_sigma_m(const OperatingPoint& point,
                                             const ExponentialTail& tail) const {
  tail.validate(range_m_);
  const Eigen::MatrixXd later = exponential_average(
      table_, tail.mean_delay_m / range_m_ * static_cast<double>(table_.rows()));
  return sigma_of(point, tail.ratio, later, 0, true);
}

double MultipathBound::mae_m(const Eigen::VectorXd& sigma_m) const {
  return mean_over_depths((mae_per_sigma() * sigma_m).cwiseMin(0.25 * range_m_), masses_);
}

double single_path_bias_m(double ratio, double delay_m) { return ratio * delay_m / (1.0 + ratio); }

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/depth_error_loss.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {

MeasurementTable zeros_like(const MeasurementTable& table) {
  MeasurementTable zeros;
  zeros.correlation = Eigen::MatrixXd::Zero(table.samples(), table.measurements());
  zeros.ambient_gain = Eigen::VectorXd::Zero(table.measurements());
  if (table.shot_correlation.size() > 0) {
    zeros.shot_correlation = zeros.correlation;
    zeros.shot_ambient_gain = zeros.ambient_gain;
  }
  return zeros;
}

}  // namespace

DepthErrorLoss::DepthErrorLoss(const SampledCamera& camera, MeasurementTable table,
                               DepthErrorKind kind)
    : camera_(&camera),
      table_(std::move(table)),
      circular_(kind == DepthErrorKind::circular),
      curve_(camera, table_),
      decoder_(curve_),
      curve_gradient_(curve_),
      reading_gradient_(zeros_like(table_)) {
  const auto measurements = static_cast<std::size_t>(table_.measurements());
  reading_.electrons.resize(measurements);
  reading_.deviation_e.resize(measurements);
  by_electrons_.resize(measurements);
}

double DepthErrorLoss::mean_variance_e2(const OperatingPoint& point) const {
  const Eigen::VectorXd light = point.signal_e_per_s * table_.shot().colwise().mean().transpose() +
                                point.ambient_e_per_s * table_.shot_ambient();
  return (camera_->exposure_s().cwiseProduct(light) + camera_->constant_variance_e2()).mean();
}

void DepthErrorLoss::read(const OperatingPoint& point, const TrialBatch& batch, std::size_t trial) {
  const int samples = table_.samples();
  const double position = batch.trials[trial].depth_periods * samples;
  const int bin = std::min(static_cast<int>(position), samples - 1);
  const int next = bin + 1 < samples ? bin + 1 : 0;
  const double fraction = position - bin;
  reading_.bin = bin;
  reading_.fraction = fraction;
  reading_.signal_e_per_s = batch.trials[trial].albedo * point.signal_e_per_s;
  const double* normals = batch.normals_of(trial);
  const Eigen::MatrixXd& shot = table_.shot();
  const Eigen::VectorXd& shot_ambient = table_.shot_ambient();
  const auto between = [&](const Eigen::MatrixXd& values, int i) {
    return (1.0 - fraction) * values(bin, i) + fraction * values(next, i);
  };
  for (int i = 0; i < table_.measurements(); ++i) {
    const double time_s = camera_->exposure_s()[i];
    const double mean = time_s * (reading_.signal_e_per_s * between(table_.correlation, i) +
                                  point.ambient_e_per_s * table_.ambient_gain[i]);
    const double shot_e2 = time_s * (reading_.signal_e_per_s * between(shot, i) +
                                     point.ambient_e_per_s * shot_ambient[i]);
    const double deviation =
        std::sqrt(std::max(1e-6, shot_e2 + camera_->constant_variance_e2()[i]));
    const auto k = static_cast<std::size_t>(i);
    reading_.deviation_e[k] = deviation;
    reading_.electrons[k] = static_cast<float>(mean + deviation * normals[i]);
  }
}

/// Electrons depend on the means directly and on the variances as sigma e.
void DepthErrorLoss::pull_back_reading(const OperatingPoint& point, const double* normals,
                                       double weight) {
  const bool apart = reading_gradient_.shot_correlation.size() > 0;
  Eigen::MatrixXd& by_shot =
      apart ? reading_gradient_.shot_correlation : reading_gradient_.correlation;
  Eigen::VectorXd& by_shot_ambient =
      apart ? reading_gradient_.shot_ambient_gain : reading_gradient_.ambient_gain;
  const int next = reading_.bin + 1 < table_.samples() ? reading_.bin + 1 : 0;
  for (int i = 0; i < table_.measurements(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double by_mean = weight * by_electrons_[k] * camera_->exposure_s()[i];
    const double by_variance = by_mean * normals[i] / (2.0 * reading_.deviation_e[k]);
    const double lower = reading_.signal_e_per_s * (1.0 - reading_.fraction);
    const double upper = reading_.signal_e_per_s * reading_.fraction;
    reading_gradient_.correlation(reading_.bin, i) += by_mean * lower;
    reading_gradient_.correlation(next, i) += by_mean * upper;
    reading_gradient_.ambient_gain[i] += by_mean * point.ambient_e_per_s;
    by_shot(reading_.bin, i) += by_variance * lower;
    by_shot(next, i) += by_variance * upper;
    by_shot_ambient[i] += by_variance * point.ambient_e_per_s;
  }
}

double DepthErrorLoss::sum_errors(const OperatingPoint& point, const TrialBatch& batch,
                                  double sharpness, double weight, bool with_gradient) {
  const double per_trial = 1.0 / static_cast<double>(batch.trials.size());
  double sum = 0.0;
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    read(point, batch, t);
    const SoftQuestion question{batch.trials[t].depth_periods * table_.samples(), sharpness,
                                circular_};
    const double trial_weight = batch.trials[t].weight * per_trial;
    if (!with_gradient) {
      sum += trial_weight * decoder_.expected_error(curve_, reading_.electrons.data(), question);
      continue;
    }
    const double scale = weight * trial_weight;
    sum += trial_weight * decoder_.expected_error(curve_, reading_.electrons.data(), question,
                                                  static_cast<float>(scale), curve_gradient_,
                                                  by_electrons_.data());
    pull_back_reading(point, batch.normals_of(t), scale);
  }
  return sum;
}

double DepthErrorLoss::soft_error(const OperatingPoint& point, const TrialBatch& batch,
                                  double sharpness) {
  return sum_errors(point, batch, sharpness, 0.0, false);
}

double DepthErrorLoss::soft_error(const OperatingPoint& point, const TrialBatch& batch,
                                  double sharpness, double weight) {
  return sum_errors(point, batch, sharpness, weight, true);
}

void DepthErrorLoss::decode(const OperatingPoint& point, const TrialBatch& batch,
                            std::vector<double>& decoded_bin) {
  decoded_bin.resize(batch.trials.size());
  for (std::size_t t = 0; t < batch.trials.size(); ++t) {
    read(point, batch, t);
    decoded_bin[t] = decoder_.decode(curve_, reading_.electrons.data());
  }
}

MeasurementTable DepthErrorLoss::gradient() const {
  MeasurementTable result = reading_gradient_;
  curve_gradient_.pull_back(*camera_, table_, curve_, result);
  return result;
}

}  // namespace tofsmith

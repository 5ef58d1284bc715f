// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/trial_model.hpp"

#include <cmath>
#include <limits>

#include "camera/shared/raw_numbers.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

namespace {

constexpr int least_rows_per_bin = 16;

TapConversion conversion_of(const Sensor& sensor) {
  TapConversion c{
      .is_poisson = sensor.noise == NoiseModel::poisson,
      .has_adc = sensor.adc_bits.has_value(),
      .is_difference = sensor.readout == Readout::difference,
      .is_signed = sensor.is_signed(),
      .read_noise_e = static_cast<float>(sensor.read_noise_e),
      .full_well_e =
          static_cast<float>(sensor.full_well_e.value_or(std::numeric_limits<double>::infinity())),
  };
  if (c.has_adc) {
    c.dn_per_e = static_cast<float>(1.0 / *sensor.gain_e_per_dn);
    c.black_level_dn = static_cast<float>(sensor.black_level_dn.value_or(0.0));
    const ConverterNumbers numbers = raw_numbers(sensor);
    c.min_dn = static_cast<float>(numbers.min_dn);
    c.max_dn = static_cast<float>(numbers.max_dn);
  }
  return c;
}

}  // namespace

TrialModel::TrialModel(const ForwardModel& model, const Camera& camera)
    : TrialModel(model, camera,
                 camera.sensor.is_signed()
                     ? model.readout()
                     : Eigen::MatrixXd::Identity(model.tap_values(), model.tap_values())) {}

/// @param sums  combines the tap values that are drawn together: identity, or the numbers of a
///   mixer
TrialModel::TrialModel(const ForwardModel& model, const Camera& camera, const Eigen::MatrixXd& sums)
    : taps_(static_cast<int>(sums.rows())),
      samples_(model.samples()),
      rows_per_bin_(model.straight_points_per_bin(least_rows_per_bin)),
      has_own_shot_noise_(camera.sensor.is_signed()),
      exposure_s_(camera.sensor.is_signed() ? model.exposure_s() : model.tap_exposure_s()),
      ambient_e_(sums * model.tap_exposure_s().cwiseProduct(model.tap_ambient_gain())),
      dark_e_(sums * (model.tap_dark_e_per_s() * model.tap_exposure_s())),
      shot_ambient_e_(sums.cwiseAbs() *
                      model.tap_exposure_s().cwiseProduct(model.tap_ambient_gain())),
      shot_dark_e_(sums.cwiseAbs() * (model.tap_dark_e_per_s() * model.tap_exposure_s())),
      constant_variance_e2_(Eigen::VectorXd::Constant(
          taps_, camera.sensor.read_noise_e * camera.sensor.read_noise_e)),
      raw_per_e_(camera.sensor.is_signed() ? Eigen::MatrixXd::Identity(taps_, taps_)
                                           : model.readout()),
      raw_at_zero_(Eigen::VectorXd::Zero(raw_per_e_.rows())),
      conversion_(conversion_of(camera.sensor)),
      records_(rows(), (has_own_shot_noise_ ? 4 : 2) * taps_) {
  const Eigen::MatrixXd light =
      model.tap_correlation_table(rows()) * model.tap_exposure_s().asDiagonal();
  if (has_own_shot_noise_)
    fill_records(light * sums.transpose(), light * sums.cwiseAbs().transpose());
  else
    fill_records(light, {});
}

TrialModel::TrialModel(const ForwardModel& model)
    : taps_(0),
      samples_(model.samples()),
      rows_per_bin_(least_rows_per_bin),
      has_own_shot_noise_(false),
      raw_per_e_(model.measurements(), 0),
      raw_at_zero_(Eigen::VectorXd::Zero(model.measurements())),
      conversion_{.is_poisson = true},
      records_(0, 4) {}

TrialModel::TrialModel(const DecodingTable& table)
    : taps_(table.measurements()),
      samples_(table.bin_count()),
      rows_per_bin_(table.samples() / table.bin_count()),
      has_own_shot_noise_(true),
      exposure_s_(table.exposure_s),
      ambient_e_(exposure_s_.cwiseProduct(table.ambient_gain)),
      dark_e_(table.dark_electrons),
      shot_ambient_e_(exposure_s_.cwiseProduct(table.shot_ambient())),
      shot_dark_e_(table.shot_dark()),
      constant_variance_e2_(table.constant_variance_e2),
      raw_per_e_(table.gain_e_per_raw.cwiseInverse().asDiagonal()),
      raw_at_zero_(table.black_level),
      conversion_{.full_well_e = std::numeric_limits<float>::infinity()},
      records_(rows(), 4 * taps_) {
  fill_records(table.correlation * exposure_s_.asDiagonal(),
               table.shot() * exposure_s_.asDiagonal());
}

void TrialModel::fill_records(const Eigen::MatrixXd& mean, const Eigen::MatrixXd& shot) {
  const auto count = static_cast<int>(mean.rows());
  const auto fill = [&](const Eigen::MatrixXd& x, int row, int first) {
    const int next = row + 1 < count ? row + 1 : 0;
    for (int j = 0; j < taps_; ++j) {
      records_.row(row)[first + j] = static_cast<float>(x(row, j));
      records_.row(row)[first + taps_ + j] = static_cast<float>(x(next, j) - x(row, j));
    }
  };
  for (int row = 0; row < count; ++row) {
    fill(mean, row, 0);
    if (has_own_shot_noise_) fill(shot, row, 2 * taps_);
  }
}

bool TrialModel::is_linear() const {
  return !conversion_.is_poisson && !conversion_.has_adc && std::isinf(conversion_.full_well_e);
}

Eigen::VectorXd TrialModel::mean_floor_e(double ambient_e_per_s) const {
  return ambient_e_per_s * ambient_e_ + dark_e_;
}

Eigen::VectorXd TrialModel::shot_floor_e2(double ambient_e_per_s) const {
  return ambient_e_per_s * shot_ambient_e_ + shot_dark_e_;
}

}  // namespace tofsmith

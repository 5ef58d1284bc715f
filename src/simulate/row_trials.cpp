// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/row_trials.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tofsmith {

namespace {
constexpr int row_points_per_bin = 16;  // as TrialModel's
}

RowTrials::RowTrials(const ForwardModel& model, const Camera& camera)
    : measurements_(model.measurements()),
      samples_(model.samples()),
      points_(row_points_per_bin * model.samples()),
      is_poisson_(camera.sensor.noise == NoiseModel::poisson),
      read_noise_e_(camera.sensor.read_noise_e),
      mean_ambient_e_(model.exposure_s().cwiseProduct(model.ambient_gain())),
      mean_dark_e_(model.dark_electrons()) {
  const double exposure_s = model.tap_exposure_s()[0];
  if (!is_poisson_) {
    mean_e_ = exposure_s * model.correlation_table(points_).transpose();
    covariance_ = row_covariance(model, points_);
    return;
  }
  const Eigen::VectorXd bin = exposure_s * model.time_bin_table(points_);
  bin_e_.assign(bin.begin(), bin.end());
  bin_e_.push_back(bin_e_.front());
  bin_ambient_e_ = exposure_s * model.tap_ambient_gain()[0];
  bin_dark_e_ = model.expected_tap_electrons({}, 0.0)[0];
  for (int n = 0; n < samples_; ++n)
    for (int k = 0; k < measurements_; ++k)
      weights_.push_back(static_cast<float>(model.readout()(k, n)));
}

void RowTrials::draw(const TrialStreams& streams, double ambient_e_per_s, int trials,
                     TrialTile& tile) const {
  if (is_poisson_)
    draw_poisson_rows(streams, ambient_e_per_s, trials, tile);
  else
    draw_normal_rows(ambient_e_per_s, trials, tile);
}

void RowTrials::draw_poisson_rows(const TrialStreams& streams, double ambient_e_per_s, int trials,
                                  TrialTile& tile) const {
  const double floor_e = ambient_e_per_s * bin_ambient_e_ + bin_dark_e_;
  const auto read_noise_e = static_cast<float>(read_noise_e_);
  for (int k = 0; k < measurements_; ++k)
    for (int i = 0; i < trials; ++i)
      tile.taps[k * trials_per_tile + i] = read_noise_e * tile.normals[k * trials_per_tile + i];
  std::array<double, trials_per_tile> mean, count;
  for (int n = 0; n < samples_; ++n) {
    for (int i = 0; i < trials; ++i) {
      int at = tile.row[i] - n * row_points_per_bin;
      if (at < 0) at += points_;
      const double* const below = &bin_e_[static_cast<std::size_t>(at)];
      const auto trial = static_cast<std::size_t>(i);
      mean[trial] = tile.signal[i] * (below[0] + tile.share[i] * (below[1] - below[0])) + floor_e;
    }
    draw_poisson(streams, n, trials, mean.data(), count.data());
    const float* const weight = weights_.data() + n * measurements_;
    for (int k = 0; k < measurements_; ++k) {
      if (weight[k] == 0.0f) continue;
      float* const sum = tile.taps + k * trials_per_tile;
      for (int i = 0; i < trials; ++i)
        sum[i] += weight[k] * static_cast<float>(count[static_cast<std::size_t>(i)]);
    }
  }
}

void RowTrials::draw_normal_rows(double ambient_e_per_s, int trials, TrialTile& tile) const {
  const Eigen::VectorXd floor_e = ambient_e_per_s * mean_ambient_e_ + mean_dark_e_;
  Eigen::VectorXd normals(measurements_), value(measurements_);
  for (int i = 0; i < trials; ++i) {
    const Eigen::Index row = tile.row[i], next = (row + 1) % points_;
    const double share = tile.share[i], signal = tile.signal[i];
    value = signal * ((1 - share) * mean_e_.col(row) + share * mean_e_.col(next)) + floor_e;
    const Eigen::MatrixXd covariance =
        covariance_.at(row, (1 - share) * signal, (1 - share) * ambient_e_per_s) +
        covariance_.at(next, share * signal, share * ambient_e_per_s) -
        covariance_.at(row, 0.0, 0.0);
    // With pivots: rows may depend on each other.
    const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
    for (int k = 0; k < measurements_; ++k)
      normals[k] =
          std::sqrt(std::max(factor.vectorD()[k], 0.0)) * tile.normals[k * trials_per_tile + i];
    const Eigen::VectorXd mixed = factor.matrixL() * normals;
    const Eigen::VectorXd noise = factor.transpositionsP().transpose() * mixed;
    value += noise;
    for (int k = 0; k < measurements_; ++k)
      tile.taps[k * trials_per_tile + i] = static_cast<float>(value[k]);
  }
}

}  // namespace tofsmith

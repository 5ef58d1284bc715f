// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/row_trials.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace tofsmith {

namespace {

/// Pivoting is needed because rows may be linearly dependent.
void add_row_noise(Eigen::MatrixXd& covariance, const double* normals, double* value) {
  const Eigen::Index count = covariance.rows();
  std::array<Eigen::Index, max_measurements> order;
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = [&](Eigen::Index i) { return order[static_cast<std::size_t>(i)]; };
    Eigen::Index largest = k;
    for (Eigen::Index i = k + 1; i < count; ++i)
      if (covariance(at(i), at(i)) > covariance(at(largest), at(largest))) largest = i;
    std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(largest)]);
    const Eigen::Index pivot = at(k);
    const double variance = covariance(pivot, pivot);
    if (!(variance > 0.0)) return;
    const double noise = std::sqrt(variance) * normals[k];
    value[pivot] += noise;
    for (Eigen::Index a = k + 1; a < count; ++a) {
      const Eigen::Index i = at(a);
      const double part = covariance(i, pivot) / variance;
      value[i] += part * noise;
      for (Eigen::Index b = k + 1; b <= a; ++b) {
        const Eigen::Index j = at(b);
        covariance(i, j) -= part * covariance(j, pivot);
        covariance(j, i) = covariance(i, j);
      }
    }
  }
}

}  // namespace

RowTrials::RowTrials(const ForwardModel& model, const Camera& camera)
    : measurements_(model.measurements()),
      samples_(model.samples()),
      points_(points_per_bin * model.samples()),
      is_poisson_(camera.sensor.noise == NoiseModel::poisson),
      read_noise_e_(camera.sensor.read_noise_e) {
  const double exposure_s = model.tap_exposure_s()[0];
  if (is_poisson_) {
    const Eigen::VectorXd bin = exposure_s * model.time_bin_table(points_);
    of_signal_.assign(bin.begin(), bin.end());
    of_signal_.push_back(of_signal_.front());
    of_ambient_ = {exposure_s * model.tap_ambient_gain()[0]};
    of_dark_ = {model.expected_tap_electrons({}, 0.0)[0]};
    for (int n = 0; n < samples_; ++n)
      for (int k = 0; k < measurements_; ++k)
        weights_.push_back(static_cast<float>(model.readout()(k, n)));
    return;
  }
  const Eigen::MatrixXd mean = exposure_s * model.correlation_table(points_);
  const RowCovariance covariance = row_covariance(model, points_);
  for (Eigen::Index point = 0; point < points_; ++point) {
    of_signal_.insert(of_signal_.end(), mean.row(point).begin(), mean.row(point).end());
    of_signal_.insert(of_signal_.end(), covariance.signal.row(point).begin(),
                      covariance.signal.row(point).end());
  }
  const Eigen::VectorXd ambient = model.exposure_s().cwiseProduct(model.ambient_gain());
  of_ambient_.assign(ambient.begin(), ambient.end());
  of_ambient_.insert(of_ambient_.end(), covariance.ambient.begin(), covariance.ambient.end());
  const Eigen::VectorXd dark = model.dark_electrons();
  of_dark_.assign(dark.begin(), dark.end());
  of_dark_.insert(of_dark_.end(), covariance.floor.begin(), covariance.floor.end());
}

std::vector<double> RowTrials::beside_signal(double ambient_e_per_s) const {
  std::vector<double> sums;
  for (std::size_t i = 0; i < of_ambient_.size(); ++i)
    sums.push_back(ambient_e_per_s * of_ambient_[i] + of_dark_[i]);
  return sums;
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
  const double floor_e = beside_signal(ambient_e_per_s).front();
  const auto read_noise_e = static_cast<float>(read_noise_e_);
  for (int k = 0; k < measurements_; ++k)
    for (int i = 0; i < trials; ++i)
      tile.taps[k * trials_per_tile + i] = read_noise_e * tile.normals[k * trials_per_tile + i];
  std::array<double, trials_per_tile> mean, count;
  for (int n = 0; n < samples_; ++n) {
    for (int i = 0; i < trials; ++i) {
      int at = tile.row[i] - n * points_per_bin;
      if (at < 0) at += points_;
      const double* const below = &of_signal_[static_cast<std::size_t>(at)];
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
  const std::vector<double> beside = beside_signal(ambient_e_per_s);
  std::vector<double> value(beside.size()), normals(static_cast<std::size_t>(measurements_));
  Eigen::MatrixXd covariance(measurements_, measurements_);
  for (int i = 0; i < trials; ++i) {
    const int row = tile.row[i], next = row + 1 < points_ ? row + 1 : 0;
    const double* const below = &of_signal_[static_cast<std::size_t>(row) * value.size()];
    const double* const above = &of_signal_[static_cast<std::size_t>(next) * value.size()];
    const double share = tile.share[i], signal = tile.signal[i];
    for (std::size_t n = 0; n < value.size(); ++n)
      value[n] = signal * ((1.0 - share) * below[n] + share * above[n]) + beside[n];
    const double* packed = value.data() + measurements_;
    for (int k = 0; k < measurements_; ++k) {
      normals[static_cast<std::size_t>(k)] = tile.normals[k * trials_per_tile + i];
      for (int l = 0; l <= k; ++l) covariance(k, l) = covariance(l, k) = *packed++;
    }
    add_row_noise(covariance, normals.data(), value.data());
    for (int k = 0; k < measurements_; ++k)
      tile.taps[k * trials_per_tile + i] = static_cast<float>(value[static_cast<std::size_t>(k)]);
  }
}

}  // namespace tofsmith

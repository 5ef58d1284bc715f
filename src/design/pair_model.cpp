// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/pair_model.hpp"

#include <cmath>
#include <numbers>

#include "tofsmith/camera/correlation.hpp"

namespace tofsmith {

namespace {

double sinc_squared(double x) {
  if (x == 0.0) return 1.0;
  const double value = std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
  return value * value;
}

/// G[k] of the class comment.
Eigen::VectorXcd grid_transfer(const Camera& camera, int samples) {
  const int coefficients = samples / 2 + 1;
  if (!camera.band_limited()) return Eigen::VectorXcd::Ones(coefficients);
  constexpr int images = 8;  // sinc^2 and the responses leave nothing beyond
  const Eigen::VectorXcd response = camera.transfer((images + 1) * samples);
  Eigen::VectorXcd transfer = Eigen::VectorXcd::Zero(coefficients);
  for (int k = 0; k < coefficients; ++k)
    for (int j = -images; j <= images; ++j) {
      const int n = k + j * samples;
      const std::complex<double> h = n >= 0 ? response[n] : std::conj(response[-n]);
      transfer[k] += h * sinc_squared(static_cast<double>(n) / samples);
    }
  return transfer;
}

}  // namespace

PairModel::PairModel(const CorrelationTarget& target, const Camera& camera)
    : target_(target),
      camera_(camera),
      peak_factor_(camera.light.peak_factor),
      shortest_run_(camera.sensor.shortest_pulse_s.value_or(0.0) * camera.fundamental_frequency_hz),
      binary_modulation_(camera.light.binary),
      binary_demodulation_(camera.sensor.binary),
      transform_(static_cast<int>(target.samples.size())),
      reversed_target_(target.samples.size()) {
  const Eigen::Index size = target.samples.size();
  for (Eigen::Index n = 0; n < size; ++n) reversed_target_[n] = target.samples[(size - n) % size];
  target_spectrum_ = spectrum(target.samples);
  grid_transfer_ = grid_transfer(camera, samples()) / static_cast<double>(samples());
}

Eigen::VectorXcd PairModel::spectrum(const Eigen::VectorXd& samples) const {
  Eigen::VectorXcd result;
  transform_.forward(samples, result);
  return result;
}

Eigen::VectorXd PairModel::demodulation_kernel(const Eigen::VectorXd& modulation) const {
  Eigen::VectorXd kernel;
  transform_.inverse(spectrum(modulation).conjugate().cwiseProduct(grid_transfer_), kernel);
  return kernel;
}

Eigen::VectorXd PairModel::modulation_kernel(const Eigen::VectorXd& demodulation) const {
  Eigen::VectorXd kernel;
  transform_.inverse(spectrum(demodulation).cwiseProduct(grid_transfer_).conjugate(), kernel);
  return kernel;
}

double PairModel::residual_rms(const Eigen::VectorXcd& modulation,
                               const Eigen::VectorXcd& demodulation) const {
  const Eigen::VectorXd energy =
      (demodulation.cwiseProduct(modulation.conjugate()).cwiseProduct(grid_transfer_) -
       target_spectrum_)
          .cwiseAbs2();
  // Parseval over the half spectrum: all but k = 0 (and N/2) stand for two coefficients.
  double sum = 2.0 * energy.sum() - energy[0];
  if (samples() % 2 == 0) sum -= energy[energy.size() - 1];
  return std::sqrt(sum) / samples();
}

double PairModel::residual_rms(const Eigen::VectorXd& modulation,
                               const Eigen::VectorXd& demodulation) const {
  return residual_rms(spectrum(modulation), spectrum(demodulation));
}

double PairModel::residual_rms(const WaveformPair& pair) const {
  const CorrelationFunction function =
      camera_.band_limited()
          ? CorrelationFunction(pair.demodulation, pair.modulation, camera_.transfer(4 * samples()))
          : CorrelationFunction(pair.demodulation, pair.modulation);
  constexpr int points_per_bin = 8;
  const Eigen::VectorXd values = function.table(points_per_bin * samples());
  double sum = 0.0;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const Eigen::Index bin = j / points_per_bin;
    const double share = static_cast<double>(j % points_per_bin) / points_per_bin;
    const double target = (1.0 - share) * target_.samples[bin] +
                          share * target_.samples[(bin + 1) % target_.samples.size()];
    sum += (values[j] - target) * (values[j] - target);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/pair_model.hpp"

#include <cmath>
#include <limits>

#include "camera/shared/actual_code.hpp"
#include "design/grid_transfer.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

PairModel::PairModel(const CorrelationTarget& target, const Camera& camera)
    : target_(target),
      camera_(camera),
      peak_factor_(camera.light.peak_factor),
      shortest_run_(shortest_run_periods(camera)),
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
  // Parseval: coefficients other than k = 0 (and N/2) count twice.
  double sum = 2.0 * energy.sum() - energy[0];
  if (samples() % 2 == 0) sum -= energy[energy.size() - 1];
  return std::sqrt(sum) / samples();
}

double PairModel::residual_rms(const Eigen::VectorXd& modulation,
                               const Eigen::VectorXd& demodulation) const {
  return residual_rms(spectrum(modulation), spectrum(demodulation));
}

WaveformPair PairModel::actual(const WaveformPair& pair) const {
  const double f0_hz = camera_.fundamental_frequency_hz;
  WaveformPair generated_pair = pair;
  if (const auto& generator = camera_.light.generator)
    generated_pair.modulation = at_average_power(generated(pair.modulation, *generator, f0_hz));
  if (const auto& generator = camera_.sensor.generator)
    generated_pair.demodulation = generated(pair.demodulation, *generator, f0_hz);
  return generated_pair;
}

double PairModel::residual_rms(const WaveformPair& nominal) const {
  const WaveformPair pair = actual(nominal);
  if (pair.modulation.mean() <= 0.0) return std::numeric_limits<double>::infinity();
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

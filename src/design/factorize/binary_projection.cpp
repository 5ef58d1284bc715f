// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/binary_projection.hpp"

#include <algorithm>
#include <utility>

namespace tofsmith {

Eigen::VectorXd binary_demodulation(const Eigen::VectorXd& x, double threshold) {
  return (x.array() > threshold).cast<double>();
}

Eigen::VectorXd binary_modulation(const Eigen::VectorXd& x, double threshold, double peak_factor) {
  Eigen::VectorXd on = (x.array() > threshold * x.maxCoeff()).cast<double>();
  const double duty = on.mean();
  if (duty > 0.0) on *= std::min(peak_factor, 1.0 / duty);
  return on;
}

BinaryProjection project_to_binary(const PairModel& model, const SampledPair& relaxed) {
  constexpr int levels = 20;
  BinaryProjection best{relaxed, 0.0};
  if (model.binary_demodulation())
    best.pair.demodulation = binary_demodulation(relaxed.demodulation, 0.5);
  if (model.binary_modulation())
    best.pair.modulation = binary_modulation(relaxed.modulation, 0.5, model.peak_factor());
  Eigen::VectorXcd modulation = model.spectrum(best.pair.modulation);
  Eigen::VectorXcd demodulation = model.spectrum(best.pair.demodulation);
  best.residual_rms = model.residual_rms(modulation, demodulation);

  const auto keep_better = [&](Eigen::VectorXd trial, Eigen::VectorXd& kept,
                               Eigen::VectorXcd& spectrum) {
    Eigen::VectorXcd other = model.spectrum(trial);
    std::swap(spectrum, other);
    const double residual = model.residual_rms(modulation, demodulation);
    if (residual >= best.residual_rms) return std::swap(spectrum, other);
    best.residual_rms = residual;
    kept = std::move(trial);
  };
  for (int round = 0; round < 2; ++round) {
    for (int level = 1; level < levels && model.binary_demodulation(); ++level)
      keep_better(binary_demodulation(relaxed.demodulation, static_cast<double>(level) / levels),
                  best.pair.demodulation, demodulation);
    for (int level = 1; level < levels && model.binary_modulation(); ++level)
      keep_better(binary_modulation(relaxed.modulation, static_cast<double>(level) / levels,
                                    model.peak_factor()),
                  best.pair.modulation, modulation);
  }
  return best;
}

}  // namespace tofsmith

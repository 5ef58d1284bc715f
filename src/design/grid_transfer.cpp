// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/grid_transfer.hpp"

#include <cmath>
#include <numbers>

namespace tofsmith {

namespace {

double sinc_squared(double x) {
  if (x == 0.0) return 1.0;
  const double value = std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
  return value * value;
}

}  // namespace

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

}  // namespace tofsmith

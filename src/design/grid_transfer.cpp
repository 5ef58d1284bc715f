// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/grid_transfer.hpp"

#include <cmath>
#include <numbers>

#include "tofsmith/camera/forward_model.hpp"

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
  constexpr int images = 8;  // negligible beyond
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

Eigen::VectorXcd harmonic_shares(const Camera& camera, int samples) {
  const int highest = harmonics_kept(samples);
  const Eigen::VectorXcd response = camera.transfer(highest);
  const Eigen::VectorXcd grid = grid_transfer(camera, samples);
  const double smallest = 1e-12 * grid.cwiseAbs().maxCoeff();
  Eigen::VectorXcd shares = Eigen::VectorXcd::Zero(highest + 1);
  Eigen::Index used = 1;
  for (int n = 0; n <= highest; ++n) {
    const int k = n % samples;
    const std::complex<double> whole = k < grid.size() ? grid[k] : std::conj(grid[samples - k]);
    const std::complex<double> part = response[n] * sinc_squared(static_cast<double>(n) / samples);
    if (std::abs(whole) <= 1e-3 * smallest) continue;  // rounding
    shares[n] = part / whole;
    if (std::abs(part) > smallest) used = n + 1;
  }
  return shares.head(used);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/shared/periodic.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {
// Relative; omitted harmonics may cause such values where the response is 0.
constexpr double rounding = 1e-7;
}  // namespace

void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope) {
  const Eigen::Index highest = harmonics.size() - 1;
  const auto points = static_cast<int>(4 * highest);
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(2 * highest + 1);
  Eigen::VectorXcd slope_spectrum = spectrum;
  for (Eigen::Index n = 0; n <= highest; ++n) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(n);
    spectrum[n] = harmonics[n] * static_cast<double>(points);
    slope_spectrum[n] = std::complex<double>(0.0, turn) * spectrum[n];
  }
  const PeriodicTransform transform(points);
  transform.inverse(spectrum, values);
  transform.inverse(slope_spectrum, slope);
}

double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e) {
  const double least = rounding * shape.maxCoeff();
  double sum = 0.0;
  for (Eigen::Index j = 0; j < shape.size(); ++j) {
    const double value = std::abs(shape[j]) < least ? least : shape[j];
    const double variance_e2 = signal_e * value + other_e;
    if (variance_e2 <= 0.0) return infinity;
    sum += std::pow(signal_e * slope[j], 2) / variance_e2;
  }
  return sum / static_cast<double>(shape.size());
}

PhotonInformation::PhotonInformation(const Eigen::VectorXcd& transfer, bool may_ring)
    : may_ring_(may_ring) {
  for (Eigen::Index n = 1; n < transfer.size(); ++n) {
    const double slope = 2.0 * std::numbers::pi * static_cast<double>(n) * std::abs(transfer[n]);
    largest_slope_power_ = std::max(largest_slope_power_, slope * slope);
  }
  sample_with_slope(transfer, response_, slope_);
}

double PhotonInformation::of_impulses(double signal_e, double other_e) const {
  return information_of_shape(response_, slope_, signal_e, other_e);
}

double PhotonInformation::of_ripple(double signal_e, double other_e, double peak_factor) const {
  const double min_e = other_e - signal_e * undershoot(peak_factor);
  if (min_e <= 0.0) return infinity;
  // The variance of values in [0, p] with mean mu <= 1 is at most mu (p - mu).
  const double mean = std::min(1.0, 0.5 * peak_factor);
  return signal_e * signal_e * largest_slope_power_ * mean * (peak_factor - mean) / min_e;
}

double PhotonInformation::largest(double signal_e, double other_e, double peak_factor) const {
  return std::min(of_impulses(signal_e, other_e), of_ripple(signal_e, other_e, peak_factor));
}

double PhotonInformation::undershoot(double peak_factor) const {
  const double least = response_.minCoeff();
  if (!may_ring_ || least >= -rounding * response_.maxCoeff()) return 0.0;
  // Light within its peak reaches at most p times the negative part.
  return std::min(-least, -peak_factor * response_.cwiseMin(0.0).mean());
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_bins.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith::benchmarks {

ReferenceCurve::ReferenceCurve(const DecodingTable& table)
    : samples_(table.samples()),
      dark_raw_(table.black_level + table.dark_electrons.cwiseQuotient(table.gain_e_per_raw)),
      gain_e_per_raw_(table.gain_e_per_raw),
      ambient_(table.exposure_s.cwiseProduct(table.ambient_gain)) {
  if (ambient_.norm() > 1e-9 * table.exposure_s.norm())
    ambient_.normalize();
  else
    ambient_.setZero();
  Eigen::MatrixXd curve = (table.correlation * table.exposure_s.asDiagonal()).transpose();
  curve -= ambient_ * (ambient_.transpose() * curve).eval();
  const Eigen::VectorXd length = curve.colwise().norm();
  require(length.minCoeff() > 1e-9 * length.maxCoeff(), "DecodingTable::correlation",
          length.minCoeff(), "must have contrast in every bin");

  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(curve);
  qr.setThreshold(1e-11);
  rank_ = static_cast<int>(qr.rank());
  require(rank_ >= 2 && rank_ <= max_rank, "rank", rank_, "must be in [2, 8]");
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(table.measurements(), rank_);
  coordinates_ = basis.transpose();

  const Eigen::MatrixXd units = coordinates_ * curve.colwise().normalized();
  rows_.resize(static_cast<std::size_t>(blocks() * rank_ * reference_block));
  for (int row = 0; row < blocks() * reference_block; ++row)
    for (int j = 0; j < rank_; ++j)
      rows_[static_cast<std::size_t>((row / reference_block * rank_ + j) * reference_block +
                                     row % reference_block)] =
          units(j, std::min(row, samples_ - 1));
}

double ReferenceCurve::score(const ReferencePixel& pixel, int row) const {
  double sum = 0.0;
  for (int j = 0; j < rank_; ++j)
    sum += pixel.unit[static_cast<std::size_t>(j)] * component(row, j);
  return sum;
}

ReferencePixel ReferenceCurve::project(const float* raw) const {
  std::array<double, 64> electrons;
  double along = 0.0, size = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    const double y = (raw[k] - dark_raw_[k]) * gain_e_per_raw_[k];
    electrons[static_cast<std::size_t>(k)] = y;
    along += ambient_[k] * y;
    size += std::abs(y);
  }
  ReferencePixel pixel;
  pixel.is_number = std::isfinite(size);
  double square = 0.0;
  for (int j = 0; j < rank_; ++j) {
    double sum = 0.0;
    for (int k = 0; k < measurements(); ++k)
      sum += coordinates_(j, k) * (electrons[static_cast<std::size_t>(k)] - along * ambient_[k]);
    pixel.unit[static_cast<std::size_t>(j)] = sum;
    square += sum * sum;
  }
  double residual2 = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    const double left = electrons[static_cast<std::size_t>(k)] - along * ambient_[k];
    residual2 += left * left;
  }
  const double length = std::sqrt(square);
  const bool is_seen = pixel.is_number && length > 1e-12 * size;
  for (double& unit : pixel.unit) unit = is_seen ? unit / length : 0.0;
  if (is_seen) pixel.tie = reference_tie * std::max(1.0, std::sqrt(residual2) / length);
  pixel.rounding = is_seen ? 1e-15 * (4.0 + size / length) : 0.0;
  return pixel;
}

}  // namespace tofsmith::benchmarks

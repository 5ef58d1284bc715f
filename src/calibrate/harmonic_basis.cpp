// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/harmonic_basis.hpp"

#include <cmath>

#include "core/shared/decompositions.hpp"

namespace tofsmith {

namespace {

Eigen::MatrixXd basis_at(const std::vector<double>& places, int harmonics) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(places.size()), 2 * harmonics + 1);
  for (Eigen::Index f = 0; f < basis.rows(); ++f) {
    basis(f, 0) = 1.0;
    for (int n = 1; n <= harmonics; ++n) {
      const double angle = turn * n * places[static_cast<std::size_t>(f)];
      basis(f, n) = std::cos(angle);
      basis(f, harmonics + n) = std::sin(angle);
    }
  }
  return basis;
}

Eigen::MatrixXcd complex_of(const Eigen::MatrixXd& weights, int harmonics) {
  Eigen::MatrixXcd c(harmonics + 1, weights.cols());
  c.row(0) = weights.row(0).cast<std::complex<double>>();
  for (int n = 1; n <= harmonics; ++n)
    for (Eigen::Index k = 0; k < weights.cols(); ++k)
      c(n, k) = {0.5 * weights(n, k), -0.5 * weights(harmonics + n, k)};
  return c;
}

Eigen::MatrixXd weights_of(const Eigen::MatrixXcd& c) {
  const Eigen::Index harmonics = c.rows() - 1;
  Eigen::MatrixXd weights(2 * harmonics + 1, c.cols());
  weights.row(0) = c.row(0).real();
  weights.middleRows(1, harmonics) = 2 * c.bottomRows(harmonics).real();
  weights.bottomRows(harmonics) = -2 * c.bottomRows(harmonics).imag();
  return weights;
}

}  // namespace

HarmonicBasis::HarmonicBasis(const std::vector<double>& places, int harmonics)
    : harmonics_(harmonics), basis_(basis_at(places, harmonics)) {
  inverse_ = solve_symmetric(basis_.transpose() * basis_, basis_.transpose());
}

Eigen::MatrixXcd HarmonicBasis::coefficients(const Eigen::MatrixXd& values) const {
  return complex_of(inverse_ * values, harmonics_);
}

Eigen::MatrixXd HarmonicBasis::values(const Eigen::MatrixXcd& coefficients) const {
  return basis_ * weights_of(coefficients);
}

Eigen::MatrixXd curve_of(const Eigen::MatrixXcd& coefficients, int rows) {
  std::vector<double> places;
  for (int j = 0; j < rows; ++j) places.push_back(static_cast<double>(j) / rows);
  return basis_at(places, static_cast<int>(coefficients.rows()) - 1) * weights_of(coefficients);
}

Eigen::MatrixXcd advanced(Eigen::MatrixXcd coefficients, double shift) {
  for (Eigen::Index n = 1; n < coefficients.rows(); ++n)
    coefficients.row(n) *= std::polar(1.0, turn * static_cast<double>(n) * shift);
  return coefficients;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

// Eigen's decompositions of matrices of any size, compiled here once: wherever one is instantiated
// it costs seconds, ten for the first.

/// A = U diag(values) V^T with as many values as the shorter side; the largest first.
struct ThinSvd {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;
  Eigen::MatrixXd v;
};
ThinSvd thin_svd(const Eigen::MatrixXd& matrix);

/// The matrix P with P A = 1 for independent columns, and how many columns are independent: those
/// whose pivot exceeds `threshold` times the largest.
struct PseudoInverse {
  Eigen::Index rank = 0;
  Eigen::MatrixXd inverse;
};
PseudoInverse pseudo_inverse(const Eigen::MatrixXd& matrix, double threshold);

/// The x with the least |A x - values|.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);

/// The lower triangle L with A = L L^T, for a positive definite A.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);

/// The X with A X = right, for a symmetric A that is not negative.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Orthonormal basis of the orthogonal complement of these columns, which may be dependent.
Eigen::MatrixXd complement_of(const Eigen::MatrixXd& columns);

/// The least eigenvalue of a symmetric matrix.
double least_eigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

// Decompositions of Eigen for matrices of dynamic size, compiled once here because each
// instantiation takes seconds (ten for the first).

/// A = U diag(values) V^T with min(rows, columns) values in descending order.
struct ThinSvd {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;
  Eigen::MatrixXd v;
};
ThinSvd thin_svd(const Eigen::MatrixXd& matrix);

/// The matrix P with P A = 1 for independent columns, and the number of independent columns, whose
/// pivots exceed `threshold` times the largest.
struct PseudoInverse {
  Eigen::Index rank = 0;
  Eigen::MatrixXd inverse;
};
PseudoInverse pseudo_inverse(const Eigen::MatrixXd& matrix, double threshold);

/// Returns the x that minimizes |A x - values|.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);

/// Returns the lower triangle L with A = L L^T for a positive definite A.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);

/// Returns the X with A X = right for a positive semidefinite A.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Returns an orthonormal basis of the orthogonal complement of the columns, which may be
/// dependent.
Eigen::MatrixXd complement_of(const Eigen::MatrixXd& columns);

/// Returns the smallest eigenvalue of a symmetric matrix.
double least_eigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace tofsmith

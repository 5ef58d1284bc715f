// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

// Decompositions of Eigen, compiled once here because each instantiation takes seconds.

/// A = U diag(values) V^T, values in descending order.
struct ThinSvd {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;
  Eigen::MatrixXd v;
};
ThinSvd thin_svd(const Eigen::MatrixXd& matrix);

/// P with P A = 1 for independent columns, whose pivots exceed `threshold` times the largest, and
/// their number.
struct PseudoInverse {
  Eigen::Index rank = 0;
  Eigen::MatrixXd inverse;
};
PseudoInverse pseudo_inverse(const Eigen::MatrixXd& matrix, double threshold);

/// x that minimizes |A x - values|.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);

/// Lower triangle L with A = L L^T for a positive definite A.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix);

/// X with A X = right for a positive semidefinite A.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Orthonormal basis of the orthogonal complement of the columns, which may be dependent.
Eigen::MatrixXd complement_of(const Eigen::MatrixXd& columns);

/// Smallest eigenvalue of a symmetric matrix.
double least_eigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace tofsmith

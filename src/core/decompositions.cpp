// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <memory>
#include <new>

namespace tofsmith {

ThinSvd thin_svd(const Eigen::MatrixXd& matrix) {
  auto svd = std::make_unique<Eigen::JacobiSVD<Eigen::MatrixXd>>();
  try {
    svd->compute(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  } catch (const std::bad_alloc&) {
    // Eigen's destructor would free memory twice after this exception, so leak the object.
    [[maybe_unused]] const auto* const leaked = svd.release();
    throw;
  }
  return {svd->matrixU(), svd->singularValues(), svd->matrixV()};
}

PseudoInverse pseudo_inverse(const Eigen::MatrixXd& matrix, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(threshold);
  solver.compute(matrix);
  return {solver.rank(), solver.pseudoInverse()};
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(matrix).solve(values);
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& matrix) {
  return Eigen::LLT<Eigen::MatrixXd>(matrix).matrixL();
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return Eigen::LDLT<Eigen::MatrixXd>(matrix).solve(right);
}

Eigen::MatrixXd complement_of(const Eigen::MatrixXd& columns) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd q = qr.householderQ();
  return q.rightCols(columns.rows() - qr.rank());
}

double least_eigenvalue(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

}  // namespace tofsmith

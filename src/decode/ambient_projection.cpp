// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/ambient_projection.hpp"

#include "core/shared/decompositions.hpp"

namespace tofsmith {

namespace {
// Relative thresholds below which a residual is rounding error.
constexpr double no_ambient = 1e-9;
constexpr double no_dimension = 1e-12;
constexpr double no_contrast = 1e-9;
// Relative distance below which singular values count as equal.
constexpr double tied_values = 1e-6;

/// Returns an orthonormal basis of the column space that does not depend on the given basis. Each
/// vector is the projection of the unit vector that is closest to the remaining space (the first
/// one in case of ties).
Eigen::MatrixXd settled_basis(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd left = columns * columns.transpose();  // column i: projection of unit vector i
  Eigen::MatrixXd basis(columns.rows(), columns.cols());
  for (Eigen::Index i = 0; i < basis.cols(); ++i) {
    const Eigen::VectorXd lengths = left.colwise().norm();
    Eigen::Index first = 0;
    while (lengths[first] < (1.0 - tied_values) * lengths.maxCoeff()) ++first;
    basis.col(i) = left.col(first) / lengths[first];
    left -= basis.col(i) * (basis.col(i).transpose() * left).eval();
  }
  return basis;
}

/// Makes the directions of equal singular values the same on every processor: the noise of a random
/// seed is drawn along them.
void settle(Eigen::MatrixXd& directions, const Eigen::VectorXd& values) {
  for (Eigen::Index begin = 0, end = 0; begin < directions.cols(); begin = end) {
    while (end < directions.cols() && values[end] >= (1.0 - tied_values) * values[begin]) ++end;
    directions.middleCols(begin, end - begin) =
        settled_basis(directions.middleCols(begin, end - begin));
  }
}

}  // namespace

AmbientProjection::AmbientProjection(const DecodingTable& table) {
  ambient = table.exposure_s.cwiseProduct(table.ambient_gain);
  if (ambient.norm() <= no_ambient * table.exposure_s.norm()) ambient.setZero();
  gated = table.correlation * table.exposure_s.asDiagonal();

  Eigen::MatrixXd projected = gated;
  Eigen::VectorXd direction = ambient;
  if (table.has_rows()) {
    projected *= table.whitening.transpose();
    direction = table.whitening * ambient;
  }
  const double whole = projected.norm();
  if (!ambient.isZero(0.0)) {
    direction.normalize();
    projected -= (projected * direction) * direction.transpose();
  }

  const ThinSvd svd = thin_svd(projected);
  Eigen::Index kept = 0;
  while (kept < svd.values.size() && svd.values[kept] > no_dimension * whole) ++kept;
  noise_basis = svd.v.leftCols(kept);
  settle(noise_basis, svd.values);
  // Strong ambient light would amplify the rounding error of the SVD along `direction`.
  if (!ambient.isZero(0.0)) noise_basis -= direction * (direction.transpose() * noise_basis).eval();
  basis = noise_basis;
  if (table.has_rows()) basis = table.whitening.transpose() * noise_basis;

  curve = projected * noise_basis;
  const double largest = curve.rows() > 0 && kept > 0 ? curve.rowwise().norm().maxCoeff() : 0.0;
  for (Eigen::Index n = 0; n < curve.rows(); ++n)
    if (curve.row(n).norm() <= no_contrast * largest) curve.row(n).setZero();
}

ExpectedNoise::ExpectedNoise(const DecodingTable& table)
    : shot_gated(table.shot() * table.exposure_s.asDiagonal()),
      shot_ambient(table.shot_ambient().cwiseProduct(table.exposure_s)),
      floor_variance_e2(table.shot_dark() + table.constant_variance_e2) {
  if (table.ambient_gain.isZero(0.0))
    floor_variance_e2 += table.hidden_ambient_e_per_s * shot_ambient;
}

}  // namespace tofsmith

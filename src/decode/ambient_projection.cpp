// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/ambient_projection.hpp"

#include "core/shared/decompositions.hpp"

namespace tofsmith {

namespace {
// Below these shares of the whole, a residual is rounding.
constexpr double no_ambient = 1e-9;
constexpr double no_dimension = 1e-12;
constexpr double no_contrast = 1e-9;
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
  basis = noise_basis;
  if (table.has_rows()) basis = table.whitening.transpose() * noise_basis;

  curve = projected * noise_basis;
  const double largest = curve.rows() > 0 && kept > 0 ? curve.rowwise().norm().maxCoeff() : 0.0;
  for (Eigen::Index n = 0; n < curve.rows(); ++n)
    if (curve.row(n).norm() <= no_contrast * largest) curve.row(n).setZero();
}

}  // namespace tofsmith

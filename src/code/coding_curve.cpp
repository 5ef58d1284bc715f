// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/families.hpp"

#include <algorithm>

#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
Eigen::MatrixXd about_mean(const Eigen::MatrixXd& table) {
  require(table.rows() >= 2, "rows of the correlation table", table.rows(), "must be >= 2");
  return table.rowwise() - table.colwise().mean();
}
}  // namespace

double coding_curve_length(const Eigen::MatrixXd& table) {
  double length = 0.0;
  for (Eigen::Index n = 0; n < table.rows(); ++n)
    length += (table.row((n + 1) % table.rows()) - table.row(n)).norm();
  return length;
}

int harmonics_used(const Eigen::MatrixXd& table, double share) {
  require(share > 0.0 && share <= 1.0, "share", share, "must be in (0, 1]");
  const PeriodicTransform transform(static_cast<int>(table.rows()));
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(transform.coefficients());
  Eigen::VectorXcd spectrum;
  for (Eigen::Index k = 0; k < table.cols(); ++k) {
    transform.forward(table.col(k), spectrum);
    energy += spectrum.cwiseAbs2();
  }
  energy[0] = 0.0;
  const double total = energy.sum();
  double sum = 0.0;
  for (int h = 1; h < energy.size(); ++h) {
    sum += energy[h];
    if (sum >= share * total) return h;
  }
  return static_cast<int>(energy.size()) - 1;
}

Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table) {
  const Eigen::MatrixXd centred = about_mean(table);
  const ThinSvd svd = thin_svd(centred);
  const Eigen::Index axes = std::min<Eigen::Index>(3, centred.cols());
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(table.rows(), 3);
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    // The remainder beyond the rank of the curve is rounding error.
    if (svd.values[axis] < 1e-9 * svd.values[0]) break;
    points.col(axis) = centred * svd.v.col(axis);
  }
  return points;
}

int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance) {
  const Eigen::VectorXd values = thin_svd(about_mean(table)).values;
  return static_cast<int>((values.array() > tolerance * std::max(values[0], 1e-300)).count());
}

}  // namespace tofsmith

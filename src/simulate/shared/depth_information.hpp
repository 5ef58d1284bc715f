// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

/// Depths per bin in a Cramer-Rao bound.
constexpr int cells_per_bin = 4;
/// Returns this number, or more if the highest harmonics of the correlation functions require it.
inline int default_cells_per_bin(const ForwardModel& model) {
  return model.has_rows() ? cells_per_bin : model.straight_points_per_bin(cells_per_bin);
}
constexpr double min_e2 = 1e-9;  // avoids 0 / 0 without light and noise

/// Returns values at the centre of cells and slopes over each cell, from a table of twice as many
/// points.
inline void middles_and_slopes(const Eigen::MatrixXd& fine, Eigen::MatrixXd& middle,
                               Eigen::MatrixXd& slope) {
  const Eigen::Index cells = fine.rows() / 2;
  middle.resize(cells, fine.cols());
  slope.resize(cells, fine.cols());
  for (Eigen::Index j = 0; j < cells; ++j) {
    middle.row(j) = fine.row(2 * j + 1);
    slope.row(j) = (fine.row((2 * j + 2) % fine.rows()) - fine.row(2 * j)) * double(cells);
  }
}

/// Adjoint of middles_and_slopes().
inline Eigen::MatrixXd pull_back_middles_and_slopes(const Eigen::MatrixXd& by_middle,
                                                    const Eigen::MatrixXd& by_slope) {
  const Eigen::Index cells = by_middle.rows();
  Eigen::MatrixXd by_fine(2 * cells, by_middle.cols());
  for (Eigen::Index j = 0; j < cells; ++j) {
    by_fine.row(2 * j + 1) = by_middle.row(j);
    by_fine.row(2 * j) = (by_slope.row((j + cells - 1) % cells) - by_slope.row(j)) * double(cells);
  }
  return by_fine;
}

/// Component of the depth column of a whitened Jacobian that is orthogonal to the other two:
///   across = by_depth - signal_share by_signal - ambient_share by_ambient,
///   [F^-1]_zz = 1 / |across|^2.
/// Well-defined even if the matrix is singular.
template <typename Vector>
struct DepthPart {
  DepthPart(Vector by_depth, Vector by_signal, Vector by_ambient) {
    const double depth_norm = by_depth.norm();
    const double ambient_scale = normalize_or_drop(by_ambient, by_ambient.norm());
    const double signal_norm = by_signal.norm();
    const double signal_along = take_out(by_signal, by_ambient);
    const double signal_scale = normalize_or_drop(by_signal, signal_norm);
    const double depth_along = take_out(by_depth, by_ambient);
    signal_share = take_out(by_depth, by_signal) * signal_scale;
    ambient_share = (depth_along - signal_share * signal_along) * ambient_scale;
    length = by_depth.norm();
    if (!(length > 1e-10 * depth_norm)) length = 0.0;
    across = by_depth;
  }

  /// Standard deviation [m]; infinite if depth cannot be separated from the other columns.
  double deviation_m(double range_m) const { return length > 0.0 ? range_m / length : infinity; }

  Vector across;
  double length;  ///< of across; 0 if only rounding error remains
  double signal_share, ambient_share;

 private:
  /// Returns the removed component along `direction` (unit length or zero).
  static double take_out(Vector& vector, const Vector& direction) {
    const double along = vector.dot(direction);
    vector -= along * direction;
    return along;
  }

  /// Sets the vector to zero if only rounding error remains. Returns the scale factor.
  static double normalize_or_drop(Vector& vector, double original_norm) {
    const double norm = vector.norm();
    if (norm > 1e-10 * original_norm && norm > 0.0) {
      vector /= norm;
      return 1.0 / norm;
    }
    vector.setZero();
    return 0.0;
  }
};

}  // namespace tofsmith

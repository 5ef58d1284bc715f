// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// The turn of a curve from each row to the next [rad], (N); 0 where one of them has no contrast.
Eigen::VectorXd turns_of(const RowMajorMatrix& curve);

/// Returns whether the curve passes the direction `unit` elsewhere at no more than half of `turn`
/// per row: a fast part such as the fall of a ramp, where a depth is far less likely.
bool is_passed_slowly(const Eigen::RowVectorXd& unit, double turn, const RowMajorMatrix& units,
                      const Eigen::VectorXd& turn_rad);

/// A closed curve that its rows determine, because it is band-limited: trigonometric interpolation
/// gives its points and slopes everywhere.
class SmoothCurve {
 public:
  /// Returns nothing where the rows may hide something: the spectrum has not fallen to 1e-6 of the
  /// whole in its upper quarter, some row has no contrast, or the curve falls back quickly along
  /// directions that it also passes slowly.
  static std::optional<SmoothCurve> of(const RowMajorMatrix& curve);

  int rows() const { return rows_; }
  /// Points at row n + offset, (N, columns).
  RowMajorMatrix points(double offset) const { return at(offset, false); }
  /// Changes per row at row n + offset, (N, columns).
  RowMajorMatrix slopes(double offset) const { return at(offset, true); }

 private:
  RowMajorMatrix at(double offset, bool as_slopes) const;

  int rows_ = 0;
  Eigen::MatrixXcd spectrum_;  // (N / 2 + 1, columns)
};

/// Columns at `factor` times as many rows, by trigonometric interpolation.
Eigen::MatrixXd interpolated(const Eigen::MatrixXd& columns, int factor);

/// The derivative of a pixel's own correlation around each row of a smooth curve,
///   d/dt <q, u(n + t)> / |p_n| = <q, W_n + t B_n + t^2 C_n>,  u = p / |p|, |t| <= 1/2,
/// for any vector q, on the curve or not. The quadratic interpolates in the Chebyshev nodes of
/// [-1/2, 1/2], so that its error is below |u''''| / 192.
struct DepthPolynomials {
  explicit DepthPolynomials(const SmoothCurve& curve);

  RowMajorMatrix slope;      ///< W (N, rank)
  RowMajorMatrix bend;       ///< B
  RowMajorMatrix asymmetry;  ///< C
  Eigen::VectorXd growth;    ///< |p(n + t)| / |p_n| = 1 + t growth + t^2 growth_change, (N)
  Eigen::VectorXd growth_change;

  /// Root of g + b t + c t^2 that is a maximum, in [-1, 1]; 0 where there is none.
  static double maximum(double g, double b, double c);
};

/// Returns the polynomials of a smooth curve whose rows are at most 16 degrees apart, and nothing
/// for other curves, where depths lie on the chords between rows.
std::optional<DepthPolynomials> depth_polynomials(const RowMajorMatrix& curve);

/// Largest error of such a maximum, for pixels on the curve [rows].
double interpolation_error(const SmoothCurve& curve);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Returns the turn from each row to the next [rad], (N); 0 without contrast.
Eigen::VectorXd turns_of(const RowMajorMatrix& curve);

/// Returns true if the curve passes `unit` elsewhere at most half as fast as `turn` per row. The
/// faster part (e.g. the falling edge of a ramp) is then an unlikely depth.
bool is_passed_slowly(const Eigen::RowVectorXd& unit, double turn, const RowMajorMatrix& units,
                      const Eigen::VectorXd& turn_rad);

/// Closed band-limited curve, interpolated trigonometrically from its rows.
class SmoothCurve {
 public:
  /// Returns none if the rows may not determine the curve: the upper quarter of the spectrum
  /// exceeds 1e-6 of the total, a row has no contrast, or the curve quickly retraces directions
  /// that it also passes slowly.
  static std::optional<SmoothCurve> of(const RowMajorMatrix& curve);

  /// At row n + offset, (N, columns).
  RowMajorMatrix points(double offset) const { return at(offset, false); }
  /// Derivatives per row.
  RowMajorMatrix slopes(double offset) const { return at(offset, true); }

 private:
  RowMajorMatrix at(double offset, bool as_slopes) const;

  int rows_ = 0;
  Eigen::MatrixXcd spectrum_;  // (N / 2 + 1, columns)
};

/// Interpolates columns trigonometrically to `factor` times as many rows.
Eigen::MatrixXd interpolated(const Eigen::MatrixXd& columns, int factor);

/// Returns measured columns (N, K) without the harmonics above their band limit, which are noise.
/// The noise floor is the mean power P_h of harmonics above 3/8 N. The band limit H minimizes the
/// expected square error (Mallows' C_p): it maximizes the sum over h <= H of P_h - 2 floor. Columns
/// are unchanged
///   - if their upper harmonics are negligible, see SmoothCurve::of(),
///   - if the functions may have corners: H >= N / 4, or a removed value exceeds 6 times the root
///     mean square of all removed values,
///   - if N < 32, because the floor is then uncertain.
Eigen::MatrixXd without_noise_above_band_limit(const Eigen::MatrixXd& columns);

/// Derivative of the correlation of a pixel around each row of a smooth curve,
///   d/dt <q, u(n + t)> / |p_n| = <q, W_n + t B_n + t^2 C_n>,  u = p / |p|, |t| <= 1/2,
/// for any q. The quadratic interpolates at the Chebyshev nodes; its error is below |u''''| / 192.
struct DepthPolynomials {
  explicit DepthPolynomials(const SmoothCurve& curve);

  RowMajorMatrix slope;      ///< W (N, rank)
  RowMajorMatrix bend;       ///< B
  RowMajorMatrix asymmetry;  ///< C
  Eigen::VectorXd growth;    ///< |p(n + t)| / |p_n| = 1 + t growth + t^2 growth_change, (N)
  Eigen::VectorXd growth_change;

  /// Returns the root of g + b t + c t^2 that is a maximum, in [-1, 1], or 0.
  static double maximum(double g, double b, double c);
};

/// Returns none unless the curve is smooth with rows at most 16 degrees apart.
std::optional<SmoothCurve> finely_sampled_curve(const RowMajorMatrix& curve);

/// Polynomials of the finely_sampled_curve().
std::optional<DepthPolynomials> depth_polynomials(const RowMajorMatrix& curve);

/// Returns the largest error of maximum() for pixels on the curve [rows].
double interpolation_error(const SmoothCurve& curve);

}  // namespace tofsmith

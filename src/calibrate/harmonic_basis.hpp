// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

namespace tofsmith {

inline constexpr double turn = 2 * std::numbers::pi;

/// Curves y(u) = c_0 + 2 Re sum_n c_n exp(2 pi i n u) at positions u.
class HarmonicBasis {
 public:
  /// @param places     in periods (F)
  /// @param harmonics  H, with 2 H + 1 <= number of distinct positions
  HarmonicBasis(const std::vector<double>& places, int harmonics);

  int harmonics() const { return harmonics_; }
  /// Least squares coefficients c (H + 1, K) of values (F, K).
  Eigen::MatrixXcd coefficients(const Eigen::MatrixXd& values) const;
  /// Values (F, K) of coefficients c (H + 1, K).
  Eigen::MatrixXd values(const Eigen::MatrixXcd& coefficients) const;

 private:
  int harmonics_;
  Eigen::MatrixXd basis_, inverse_;  // 1, cos, sin; (F, 2 H + 1) and its pseudo-inverse
};

/// Values (rows, K) of coefficients c (H + 1, K) at j / rows.
Eigen::MatrixXd curve_of(const Eigen::MatrixXcd& coefficients, int rows);

/// c_n exp(2 pi i n shift): y(u + shift).
Eigen::MatrixXcd advanced(Eigen::MatrixXcd coefficients, double shift);

}  // namespace tofsmith

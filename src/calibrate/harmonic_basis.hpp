// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

namespace tofsmith {

inline constexpr double turn = 2 * std::numbers::pi;  ///< radians

/// Curves y(u) = c_0 + 2 Re sum_n c_n exp(2 pi i n u) through values at given places u.
class HarmonicBasis {
 public:
  /// @param places     of every value, in periods (F)
  /// @param harmonics  H, with 2 H + 1 <= number of different places
  HarmonicBasis(const std::vector<double>& places, int harmonics);

  int harmonics() const { return harmonics_; }
  /// Least squares c (H + 1, K) of values (F, K).
  Eigen::MatrixXcd coefficients(const Eigen::MatrixXd& values) const;
  /// Values (F, K) of c (H + 1, K) at the places.
  Eigen::MatrixXd values(const Eigen::MatrixXcd& coefficients) const;

 private:
  int harmonics_;
  Eigen::MatrixXd basis_, inverse_;  // 1, cos, sin; (F, 2 H + 1) and its pseudo-inverse
};

/// Values (rows, K) of c (H + 1, K) at j / rows.
Eigen::MatrixXd curve_of(const Eigen::MatrixXcd& coefficients, int rows);

/// Each row n of c times exp(2 pi i n shift): y(u + shift).
Eigen::MatrixXcd advanced(Eigen::MatrixXcd coefficients, double shift);

}  // namespace tofsmith

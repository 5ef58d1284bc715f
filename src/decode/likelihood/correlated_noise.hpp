// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "decode/multipath/shared/bounded_quadratic.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Covariance of rows between bins, linear in light(at bin, at the next bin, ambient). Allocates
/// nothing per pixel.
class CorrelatedNoise {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                               max_exposure_rows, max_exposure_rows>;
  using Column = Eigen::Matrix<double, max_exposure_rows, 1>;

  explicit CorrelatedNoise(const RowCovariance& covariance);

  /// A covariance matrix or, after factorize(), the lower triangle L of L L^T.
  struct Factor {
    Matrix values;

    /// Replaces the covariance by L; returns the logarithm of its determinant.
    double factorize(int count);
    void whiten(int count, Column& column) const;
    /// Computes L^-1 matrix L^-T for a symmetric matrix.
    void whiten(int count, Matrix& matrix) const;
  };

  void at(std::int32_t bin, std::int32_t next, const Quadratic::Vector& light,
          double min_variance_e2, double variance_share, Factor& covariance) const;
  /// Returns the derivative with respect to light 0 or 1 (at that bin) or 2.
  Matrix slope(int light, std::int32_t bin, double variance_share) const;

 private:
  int measurements_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> signal_;  // (N, pairs)
  Eigen::VectorXd ambient_, floor_;
};

}  // namespace tofsmith

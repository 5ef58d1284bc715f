// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/circulant_operator.hpp"
#include "design/piecewise_constant.hpp"

namespace tofsmith {

/// The term 1/2 |A x - b|^2 for piecewise constant x.
///
/// With W the zero-mean, doubly integrated autocorrelation R of the kernel
/// (W[n + 1] - 2 W[n] + W[n - 1] = R[n] - mean R), a jump of height h at sample s adds h W[n - s]
/// to the prefix sum G[n] = sum_{i < n} gradient[i]: no transform is needed while there are few
/// pieces. W is made by dividing spectra, not by summing twice, which would lose digits that a
/// small total-variation weight needs.
class LeastSquaresTerm {
 public:
  explicit LeastSquaresTerm(int samples);

  void set(const Eigen::VectorXd& kernel, const Eigen::VectorXd& target);

  /// Second derivative of the term with respect to the values of pieces j and k: O(1).
  double curvature(const PiecewiseConstant& x, int j, int k) const {
    const int j0 = x[j].start + samples_, j1 = x.end_of(j) + samples_;
    const int k0 = x[k].start, k1 = x.end_of(k);
    return mean_curvature_ * x[j].length * x[k].length + (curve_[j1 - k0] - curve_[j1 - k1]) -
           (curve_[j0 - k0] - curve_[j0 - k1]);
  }

  /// Prefix sums of the gradient from the start of piece 0 around the ring: sums (N + 1),
  /// sums[k] = sum of the first k samples' gradient, up to a constant. O(N J).
  void prefix_gradient(const PiecewiseConstant& x, Eigen::VectorXd& sums) const;

  /// The same through the Fourier transform of the residual: its rounding errors are relative to
  /// the residual, not to x.
  /// @return the value of the term
  double prefix_gradient_by_transform(const PiecewiseConstant& x, Eigen::VectorXd& sums);

 private:
  void add_trend(double mean_gradient, Eigen::VectorXd& sums) const;

  int samples_;
  CirculantOperator operator_;
  Eigen::VectorXcd integrator_;       // 1 / (exp(2 pi i k / N) - 1), 0 for k = 0
  Eigen::VectorXcd target_spectrum_;  // of b
  double mean_curvature_ = 0;         // mean of R
  double mean_pull_ = 0;              // mean of A^T b
  Eigen::VectorXd curve_;             // W over two periods, n = -N .. N at index n + N
  Eigen::VectorXd pull_;              // zero-mean prefix sums of A^T b over two periods
  Eigen::VectorXd signal_;            // scratch
  Eigen::VectorXcd half_;             // scratch
};

}  // namespace tofsmith

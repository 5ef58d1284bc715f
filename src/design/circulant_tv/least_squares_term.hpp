// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/shared/periodic.hpp"
#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {

enum class PieceState { at_lower, free, at_upper };

struct Piece {
  int start = 0;   ///< first sample, in [0, N)
  int length = 0;  ///< may wrap from N - 1 to 0
  double value = 0;
  /// Sign of the jump from the previous piece, even at height zero; 0 without a jump.
  int rise = 0;
  PieceState state = PieceState::free;
  double slope = 0;  ///< sum of the least-squares gradient over the piece
};

/// A signal on a ring of N samples as constant pieces in circular order.
class PiecewiseConstant {
 public:
  explicit PiecewiseConstant(int samples) : samples_(samples) { make_constant(0); }

  void make_constant(double value);
  /// Sets the pieces from `x` (N). Differences below 1e-12 of the upper bound are no jumps.
  void take_pieces_of(const Eigen::VectorXd& x, double upper_bound);

  int samples() const { return samples_; }
  int size() const { return static_cast<int>(pieces_.size()); }
  Piece& operator[](int j) { return pieces_[j]; }
  const Piece& operator[](int j) const { return pieces_[j]; }
  int previous(int j) const { return j > 0 ? j - 1 : size() - 1; }
  int next(int j) const { return j + 1 < size() ? j + 1 : 0; }
  /// First sample after piece j, in [0, N].
  int end_of(int j) const { return size() > 1 ? pieces_[next(j)].start : pieces_[0].start; }

  /// Counts pieces that differ from the previous one, at least 1.
  int distinct() const;
  double sum() const;
  double total_variation() const;
  /// Returns the slope of total variation if only piece j is raised: -2, 0 or 2.
  int variation_slope(int j) const;
  void write_to(Eigen::VectorXd& x) const;

  void merge_with_previous(int j);
  /// Frees the samples [first, last] of piece j, counted from its start, to move in `direction` (+1
  /// or -1). On a single piece the interval may wrap.
  void split(int j, int first, int last, int direction);

 private:
  int wrap(int n) const { return n >= samples_ ? n - samples_ : n; }
  int samples_;
  std::vector<Piece> pieces_;
};

/// Solves the subproblem without total variation (its weight is ignored):
///   minimize 1/2 |A x - b|^2  subject to  0 <= x <= upper_bound,  sum x <= budget
/// by accelerated projected gradients. x keeps the components of `start` (N) that the data do not
/// determine.
/// @return feasible (N); the objective does not exceed the objective of the projected start
Eigen::VectorXd least_squares_within_bounds(const CirculantTvProblem& problem,
                                            const Eigen::VectorXd& start);

/// A x = kernel * x (circular) and its adjoint on half spectra.
class CirculantOperator {
 public:
  explicit CirculantOperator(int samples) : transform_(samples) {}

  bool set_kernel(const Eigen::VectorXd& kernel) {
    if (kernel_.size() == kernel.size() && kernel_ == kernel) return false;
    kernel_ = kernel;
    transform_.forward(kernel_, spectrum_);
    return true;
  }

  const PeriodicTransform& transform() const { return transform_; }
  const Eigen::VectorXcd& spectrum() const { return spectrum_; }

  /// Parseval: sum_n r[n]^2 from the half spectrum of r.
  double energy(const Eigen::VectorXcd& half) const {
    const int samples = transform_.samples();
    double sum = 2 * half.squaredNorm() - std::norm(half[0]);
    if (samples % 2 == 0) sum -= std::norm(half[samples / 2]);
    return sum / samples;
  }

 private:
  PeriodicTransform transform_;
  Eigen::VectorXd kernel_;
  Eigen::VectorXcd spectrum_;
};

/// The term 1/2 |A x - b|^2 for piecewise constant x.
///
/// Let W be the zero-mean, doubly integrated autocorrelation R of the kernel: W[n + 1] - 2 W[n] +
/// W[n - 1] = R[n] - mean R. A jump of height h at sample s adds h W[n - s] to the prefix sum G[n]
/// = sum_{i < n} gradient[i], hence few pieces need no transform. W is computed by division of
/// spectra; summing twice would be too inaccurate.
class LeastSquaresTerm {
 public:
  explicit LeastSquaresTerm(int samples);

  void set(const Eigen::VectorXd& kernel, const Eigen::VectorXd& target);

  /// Second derivative with respect to the values of pieces j and k: O(1).
  double curvature(const PiecewiseConstant& x, int j, int k) const {
    const int j0 = x[j].start + samples_, j1 = x.end_of(j) + samples_;
    const int k0 = x[k].start, k1 = x.end_of(k);
    return mean_curvature_ * x[j].length * x[k].length + (curve_[j1 - k0] - curve_[j1 - k1]) -
           (curve_[j0 - k0] - curve_[j0 - k1]);
  }

  /// Computes prefix sums of the gradient around the ring, from the start of piece 0: sums[k] (N +
  /// 1), up to a constant. O(N J).
  void prefix_gradient(const PiecewiseConstant& x, Eigen::VectorXd& sums) const;

  /// As prefix_gradient(), but by FFT: rounding errors are relative to the residual, not to x.
  /// Returns the value of the term.
  double prefix_gradient_by_transform(const PiecewiseConstant& x, Eigen::VectorXd& sums);

 private:
  void add_trend(double mean_gradient, Eigen::VectorXd& sums) const;

  int samples_;
  CirculantOperator operator_;
  Eigen::VectorXcd integrator_;  // 1 / (exp(2 pi i k / N) - 1), 0 for k = 0
  Eigen::VectorXcd target_spectrum_;
  double mean_curvature_ = 0;  // mean of R
  double mean_pull_ = 0;       // mean of A^T b
  Eigen::VectorXd curve_;      // W, n in [-N, N] at index n + N
  Eigen::VectorXd pull_;       // zero-mean prefix sums of A^T b, two periods
  Eigen::VectorXd signal_;
  Eigen::VectorXcd half_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tofsmith {

enum class PieceState { at_lower, free, at_upper };

/// Consecutive samples of one value on the ring.
struct Piece {
  int start = 0;     ///< first sample, in [0, N)
  int length = 0;    ///< samples, may run past N - 1 and on from 0
  double value = 0;  ///< of every sample
  /// Sign of the jump from the piece before, also while the jump is still zero; 0 if there is none.
  int rise = 0;
  PieceState state = PieceState::free;
  double slope = 0;  ///< sum over the piece of the gradient of the least-squares term
};

/// A signal on a ring of N samples, held as its constant pieces in circular order.
class PiecewiseConstant {
 public:
  explicit PiecewiseConstant(int samples) : samples_(samples) { make_constant(0); }

  void make_constant(double value);
  /// Pieces of `x` (N): neighbours closer than 1e-12 of the upper bound share one; values at or
  /// beyond a bound are set to it and held there.
  void take_pieces_of(const Eigen::VectorXd& x, double upper_bound);

  int samples() const { return samples_; }
  int size() const { return static_cast<int>(pieces_.size()); }
  Piece& operator[](int j) { return pieces_[j]; }
  const Piece& operator[](int j) const { return pieces_[j]; }
  auto begin() const { return pieces_.begin(); }
  auto end() const { return pieces_.end(); }
  int previous(int j) const { return j > 0 ? j - 1 : size() - 1; }
  int next(int j) const { return j + 1 < size() ? j + 1 : 0; }
  /// First sample after piece j, in [0, N].
  int end_of(int j) const { return size() > 1 ? pieces_[next(j)].start : pieces_[0].start; }

  /// Pieces that differ from the one before, at least 1: a jump may still be, or again be, zero.
  int distinct() const;
  double sum() const;
  double total_variation() const;
  /// Slope of total variation when piece j alone is raised: -2, 0 or 2.
  int variation_slope(int j) const;
  void write_to(Eigen::VectorXd& x) const;

  /// Joins piece j to the one before; a value held at a bound wins.
  void merge_with_previous(int j);
  /// Frees the samples [first, last] of piece j, counted from its start, to move in the direction
  /// (+1 raise, -1 drop); what remains on either side keeps its value and state. The interval may
  /// run past the end of a piece that is the whole ring.
  void split(int j, int first, int last, int direction);

 private:
  int wrap(int n) const { return n >= samples_ ? n - samples_ : n; }
  int samples_;
  std::vector<Piece> pieces_;
};

}  // namespace tofsmith

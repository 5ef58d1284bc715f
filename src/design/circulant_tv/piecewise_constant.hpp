// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

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
  auto begin() const { return pieces_.begin(); }
  auto end() const { return pieces_.end(); }
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

}  // namespace tofsmith

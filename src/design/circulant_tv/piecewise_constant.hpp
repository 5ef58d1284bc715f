// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tofsmith {

enum class PieceState { at_lower, free, at_upper };

/// Consecutive samples with the same value on the ring.
struct Piece {
  int start = 0;     ///< first sample, in [0, N)
  int length = 0;    ///< number of samples; may wrap from N - 1 to 0
  double value = 0;  ///< value of every sample
  /// Sign of the jump from the previous piece, even if its height is still zero; 0 without a jump.
  int rise = 0;
  PieceState state = PieceState::free;
  double slope = 0;  ///< sum over the piece of the gradient of the least-squares term
};

/// A signal on a ring of N samples, represented by its constant pieces in circular order.
class PiecewiseConstant {
 public:
  explicit PiecewiseConstant(int samples) : samples_(samples) { make_constant(0); }

  void make_constant(double value);
  /// Sets the pieces from `x` (N). Adjacent samples that differ by less than 1e-12 of the upper
  /// bound form one piece. Values at or beyond a bound are set to the bound and fixed there.
  void take_pieces_of(const Eigen::VectorXd& x, double upper_bound);

  int samples() const { return samples_; }
  int size() const { return static_cast<int>(pieces_.size()); }
  Piece& operator[](int j) { return pieces_[j]; }
  const Piece& operator[](int j) const { return pieces_[j]; }
  auto begin() const { return pieces_.begin(); }
  auto end() const { return pieces_.end(); }
  int previous(int j) const { return j > 0 ? j - 1 : size() - 1; }
  int next(int j) const { return j + 1 < size() ? j + 1 : 0; }
  /// Returns the first sample after piece j, in [0, N].
  int end_of(int j) const { return size() > 1 ? pieces_[next(j)].start : pieces_[0].start; }

  /// Returns the number of pieces that differ from the previous one, at least 1. Jumps can have
  /// zero height, so this may be less than size().
  int distinct() const;
  double sum() const;
  double total_variation() const;
  /// Returns the slope of total variation when only piece j is raised: -2, 0 or 2.
  int variation_slope(int j) const;
  void write_to(Eigen::VectorXd& x) const;

  /// Merges piece j with the previous one; a value fixed at a bound has priority.
  void merge_with_previous(int j);
  /// Frees the samples [first, last] of piece j, counted from its start, to move in `direction`
  /// (+1: up, -1: down). The remainder on either side keeps its value and state. If the piece is
  /// the whole ring, the interval may wrap around.
  void split(int j, int first, int last, int direction);

 private:
  int wrap(int n) const { return n >= samples_ ? n - samples_ : n; }
  int samples_;
  std::vector<Piece> pieces_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/piecewise_constant.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tofsmith {

void PiecewiseConstant::make_constant(double value) {
  pieces_.assign(1, Piece{0, samples_, value, 0, PieceState::free, 0});
}

void PiecewiseConstant::take_pieces_of(const Eigen::VectorXd& x, double upper_bound) {
  const double min_jump = 1e-12 * upper_bound;
  pieces_.clear();
  for (int n = 0; n < samples_; ++n) {
    const double jump = x[n] - x[n > 0 ? n - 1 : samples_ - 1];
    if (std::abs(jump) <= min_jump) continue;
    Piece piece{n, 0, x[n], jump > 0 ? 1 : -1, PieceState::free, 0};
    if (piece.value <= min_jump) {
      piece.value = 0;
      piece.state = PieceState::at_lower;
    } else if (piece.value >= upper_bound - min_jump) {
      piece.value = upper_bound;
      piece.state = PieceState::at_upper;
    }
    pieces_.push_back(piece);
  }
  if (size() < 2) return make_constant(std::clamp(x[0], 0.0, upper_bound));
  for (int j = 0; j < size(); ++j) {
    const int length = pieces_[next(j)].start - pieces_[j].start;
    pieces_[j].length = length > 0 ? length : length + samples_;
  }
}

int PiecewiseConstant::distinct() const {
  int jumps = 0;
  for (int j = 0; j < size(); ++j) jumps += pieces_[j].value != pieces_[previous(j)].value;
  return std::max(jumps, 1);
}

double PiecewiseConstant::sum() const {
  double sum = 0;
  for (const Piece& piece : pieces_) sum += piece.value * piece.length;
  return sum;
}

double PiecewiseConstant::total_variation() const {
  double sum = 0;
  for (int j = 0; j < size(); ++j) sum += std::abs(pieces_[j].value - pieces_[previous(j)].value);
  return sum;
}

int PiecewiseConstant::variation_slope(int j) const {
  return size() > 1 ? pieces_[j].rise - pieces_[next(j)].rise : 0;
}

void PiecewiseConstant::write_to(Eigen::VectorXd& x) const {
  x.resize(samples_);
  for (const Piece& piece : pieces_) {
    const int before_end = std::min(piece.length, samples_ - piece.start);
    x.segment(piece.start, before_end).setConstant(piece.value);
    x.head(piece.length - before_end).setConstant(piece.value);
  }
}

void PiecewiseConstant::merge_with_previous(int j) {
  Piece& kept = pieces_[previous(j)];
  const Piece& gone = pieces_[j];
  kept.length += gone.length;
  kept.slope += gone.slope;
  if (kept.state == PieceState::free && gone.state != PieceState::free) {
    kept.state = gone.state;
    kept.value = gone.value;
  }
  pieces_.erase(pieces_.begin() + j);
  if (size() == 1) pieces_[0].rise = 0;
}

void PiecewiseConstant::split(int j, int first, int last, int direction) {
  const Piece whole = pieces_[j];
  const bool ring = size() == 1;
  Piece moved = whole;
  moved.start = wrap(whole.start + first);
  moved.length = last - first + 1;
  moved.state = PieceState::free;
  if (moved.length == whole.length) {
    pieces_[j].state = PieceState::free;
    return;
  }
  Piece after = whole;
  after.start = wrap(moved.start + moved.length);
  after.rise = -direction;
  if (ring) {
    after.length = samples_ - moved.length;
    moved.rise = direction;
    pieces_ = {moved, after};
    return;
  }
  Piece before = whole;
  before.length = first;
  after.length = whole.length - 1 - last;
  if (first > 0) moved.rise = direction;

  std::array<Piece, 3> parts;
  int count = 0;
  if (first > 0) parts[count++] = before;
  parts[count++] = moved;
  if (after.length > 0) parts[count++] = after;
  pieces_[j] = parts[0];
  pieces_.insert(pieces_.begin() + j + 1, parts.begin() + 1, parts.begin() + count);
}

}  // namespace tofsmith

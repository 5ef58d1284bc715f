// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/least_squares_term.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "design/circulant_tv/proximal_operators.hpp"

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

Eigen::VectorXd least_squares_within_bounds(const CirculantTvProblem& problem,
                                            const Eigen::VectorXd& start) {
  constexpr int max_steps = 500;
  constexpr double still = 1e-7;  // relative to the upper bound
  const PeriodicTransform transform(problem.samples());
  Eigen::VectorXcd kernel, target, half;
  transform.forward(problem.kernel, kernel);
  transform.forward(problem.target, target);
  const double lipschitz = kernel.cwiseAbs2().maxCoeff();

  Eigen::VectorXd x = start;
  project_on_box_and_budget(x, problem.upper_bound, problem.budget);
  if (lipschitz <= 0.0) return x;
  Eigen::VectorXd ahead = x, gradient;
  double momentum = 1.0;
  for (int step = 0; step < max_steps; ++step) {
    transform.forward(ahead, half);
    half = kernel.conjugate().cwiseProduct(kernel.cwiseProduct(half) - target);
    transform.inverse(half, gradient);
    Eigen::VectorXd next = ahead - gradient / lipschitz;
    project_on_box_and_budget(next, problem.upper_bound, problem.budget);
    const Eigen::VectorXd move = next - x;
    if (move.cwiseAbs().maxCoeff() < still * problem.upper_bound) return next;
    if ((ahead - next).dot(move) > 0.0) momentum = 1.0;
    const double grown = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    ahead = next + (momentum - 1.0) / grown * move;
    momentum = grown;
    x = next;
  }
  return x;
}

LeastSquaresTerm::LeastSquaresTerm(int samples) : samples_(samples), operator_(samples) {
  integrator_.setZero(operator_.transform().coefficients());
  for (Eigen::Index k = 1; k < integrator_.size(); ++k) {
    // exp(i t) - 1 = 2 i sin(t / 2) exp(i t / 2) avoids cancellation at small t.
    const double half_angle = std::numbers::pi * static_cast<double>(k) / samples;
    integrator_[k] = std::polar(0.5 / std::sin(half_angle), -half_angle - 0.5 * std::numbers::pi);
  }
}

void LeastSquaresTerm::set(const Eigen::VectorXd& kernel, const Eigen::VectorXd& target) {
  const PeriodicTransform& transform = operator_.transform();
  if (operator_.set_kernel(kernel)) {
    const Eigen::VectorXcd& spectrum = operator_.spectrum();
    mean_curvature_ = std::norm(spectrum[0]) / samples_;
    // A second difference multiplies the spectrum by -4 sin^2 = -1 / |integrator|^2.
    half_ =
        (-spectrum.cwiseAbs2().cwiseProduct(integrator_.cwiseAbs2())).cast<std::complex<double>>();
    transform.inverse(half_, signal_);
    curve_.resize(2 * samples_ + 1);
    curve_ << signal_, signal_, signal_[0];
  }
  transform.forward(target, target_spectrum_);
  half_ = operator_.spectrum().conjugate().cwiseProduct(target_spectrum_);
  mean_pull_ = half_[0].real() / samples_;
  half_ = half_.cwiseProduct(integrator_).eval();
  transform.inverse(half_, signal_);
  pull_.resize(2 * samples_ + 1);
  pull_ << signal_, signal_, signal_[0];
}

void LeastSquaresTerm::add_trend(double mean_gradient, Eigen::VectorXd& sums) const {
  for (int k = 0; k <= samples_; ++k) sums[k] += mean_gradient * k;
}

void LeastSquaresTerm::prefix_gradient(const PiecewiseConstant& x, Eigen::VectorXd& sums) const {
  const int origin = x[0].start;
  sums = -pull_.segment(origin, samples_ + 1);
  if (x.size() > 1)
    for (int j = 0; j < x.size(); ++j) {
      const double jump = x[j].value - x[x.previous(j)].value;
      const int lead = origin - x[j].start;
      if (jump != 0)
        sums.noalias() += jump * curve_.segment(lead > 0 ? lead : lead + samples_, samples_ + 1);
    }
  add_trend(mean_curvature_ * x.sum() - mean_pull_, sums);
}

double LeastSquaresTerm::prefix_gradient_by_transform(const PiecewiseConstant& x,
                                                      Eigen::VectorXd& sums) {
  const PeriodicTransform& transform = operator_.transform();
  x.write_to(signal_);
  transform.forward(signal_, half_);
  half_ = (operator_.spectrum().cwiseProduct(half_) - target_spectrum_).eval();
  const double value = 0.5 * operator_.energy(half_);
  half_ = half_.cwiseProduct(operator_.spectrum().conjugate()).eval();
  const double mean_gradient = half_[0].real() / samples_;
  half_ = half_.cwiseProduct(integrator_).eval();
  transform.inverse(half_, signal_);
  const int origin = x[0].start;
  sums.resize(samples_ + 1);
  sums << signal_.tail(samples_ - origin), signal_.head(origin), signal_[origin];
  add_trend(mean_gradient, sums);
  return value;
}

}  // namespace tofsmith

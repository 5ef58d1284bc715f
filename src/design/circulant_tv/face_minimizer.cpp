// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/face_minimizer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tofsmith {
namespace {

// Repeated Newton steps on one face against rounding in the reduced Hessian.
constexpr int max_refinements = 3;
// Relative to the total-variation weight.
constexpr double face_tolerance = 1e-10;

using Factor = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

}  // namespace

double FaceMinimizer::minimize(PiecewiseConstant& x, BudgetState& budget,
                               const SignalLimits& limits) {
  double decrease = 0;
  int refinements = 0;
  const int max_steps = 8 * x.size() + 64;
  for (int step = 0; step < max_steps; ++step) {
    assemble(x, limits);
    if (free_.empty()) {
      budget = {};
      break;
    }
    if (budget.active && free_.size() == 1) {
      settle_last_free_piece(x, free_[0], budget, limits);
      if (budget.multiplier >= 0) break;
      budget = {};
      continue;
    }
    solve_for_step(x, budget, limits);
    const Block block = first_block(x, budget, limits);
    decrease += advance(x, block.step);
    const int j = block.piece;
    switch (block.limit) {
      case Limit::none:
        if (residual(x, budget, limits) > face_tolerance * limits.total_variation_weight &&
            refinements++ < max_refinements)
          continue;
        if (budget.active && budget.multiplier < 0) {
          budget = {};
          refinements = 0;
          continue;
        }
        return decrease;
      case Limit::merge:
        x.merge_with_previous(j);
        break;
      case Limit::lower_bound:
        hold_at_bound(x, j, PieceState::at_lower, 0);
        break;
      case Limit::upper_bound:
        hold_at_bound(x, j, PieceState::at_upper, limits.upper_bound);
        break;
      case Limit::budget:
        budget.active = true;
        break;
    }
    refinements = 0;
  }
  return decrease;
}

void FaceMinimizer::assemble(const PiecewiseConstant& x, const SignalLimits& limits) {
  free_.clear();
  for (int j = 0; j < x.size(); ++j)
    if (x[j].state == PieceState::free) free_.push_back(j);
  const int count = static_cast<int>(free_.size());
  if (hessian_.rows() < count) {
    hessian_.resize(2 * count, 2 * count);
    factor_.resize(2 * count, 2 * count);
  }
  gradient_.resize(count);
  for (int a = 0; a < count; ++a) {
    const int j = free_[a];
    gradient_[a] = x[j].slope + limits.total_variation_weight * x.variation_slope(j);
    for (int b = a; b < count; ++b) hessian_(b, a) = term_.curvature(x, free_[b], j);
  }
}

void FaceMinimizer::factorize() {
  const int count = static_cast<int>(free_.size());
  scale_.resize(count);
  for (int a = 0; a < count; ++a)
    scale_[a] = hessian_(a, a) > 0 ? 1 / std::sqrt(hessian_(a, a)) : 1.0;
  // Damp directions without curvature (band-limited kernels).
  for (double damping = 0;; damping = std::max(1e-15, 8 * damping)) {
    for (int a = 0; a < count; ++a) {
      for (int b = a; b < count; ++b) factor_(b, a) = hessian_(b, a) * scale_[a] * scale_[b];
      factor_(a, a) += damping;
    }
    Factor in_place = factor_.topLeftCorner(count, count);
    const Eigen::LLT<Factor> cholesky(in_place);
    if (cholesky.info() == Eigen::Success) return;
  }
}

void FaceMinimizer::solve_for_step(const PiecewiseConstant& x, BudgetState& budget,
                                   const SignalLimits& limits) {
  ++newton_steps_;
  factorize();
  const int count = static_cast<int>(free_.size());
  const auto lower = factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>();
  const auto solve = [&](Eigen::VectorXd& v) {
    v.array() *= scale_.array();
    lower.solveInPlace(v);
    lower.transpose().solveInPlace(v);
    v.array() *= scale_.array();
  };
  direction_ = -gradient_;
  solve(direction_);
  budget.multiplier = 0;
  if (budget.active) {
    // [H l; l^T 0] [step; multiplier] = [-gradient; residual of the budget], with the lengths l
    pull_.resize(count);
    for (int a = 0; a < count; ++a) pull_[a] = x[free_[a]].length;
    solve(pull_);
    double reach = 0, response = 0;
    for (int a = 0; a < count; ++a) {
      reach += x[free_[a]].length * direction_[a];
      response += x[free_[a]].length * pull_[a];
    }
    budget.multiplier = (reach - (limits.budget - x.sum())) / response;
    direction_ -= budget.multiplier * pull_;
  }
  motion_.assign(x.size(), 0.0);
  for (int a = 0; a < count; ++a) motion_[free_[a]] = direction_[a];
}

FaceMinimizer::Block FaceMinimizer::first_block(const PiecewiseConstant& x,
                                                const BudgetState& budget,
                                                const SignalLimits& limits) const {
  Block first;
  const auto consider = [&](double room, double speed, Limit limit, int piece) {
    if (speed > 0 && room < speed * first.step) first = {std::max(0.0, room / speed), limit, piece};
  };
  if (x.size() > 1)
    for (int j = 0; j < x.size(); ++j) {
      const int before = x.previous(j);
      consider(x[j].rise * (x[j].value - x[before].value),
               -x[j].rise * (motion_[j] - motion_[before]), Limit::merge, j);
    }
  for (const int j : free_) {
    consider(x[j].value, -motion_[j], Limit::lower_bound, j);
    consider(limits.upper_bound - x[j].value, motion_[j], Limit::upper_bound, j);
  }
  if (!budget.active) {
    double speed = 0;
    for (const int j : free_) speed += x[j].length * motion_[j];
    consider(limits.budget - x.sum(), speed, Limit::budget, -1);
  }
  return first;
}

double FaceMinimizer::advance(PiecewiseConstant& x, double step) {
  const int count = static_cast<int>(free_.size());
  bend_.noalias() =
      hessian_.topLeftCorner(count, count).selfadjointView<Eigen::Lower>() * direction_;
  for (int a = 0; a < count; ++a) {
    x[free_[a]].value += step * direction_[a];
    x[free_[a]].slope += step * bend_[a];
  }
  return -step * (gradient_.dot(direction_) + 0.5 * step * bend_.dot(direction_));
}

double FaceMinimizer::residual(const PiecewiseConstant& x, const BudgetState& budget,
                               const SignalLimits& limits) const {
  double largest = 0;
  for (const int j : free_)
    largest = std::max(largest,
                       std::abs(x[j].slope + limits.total_variation_weight * x.variation_slope(j) +
                                budget.multiplier * x[j].length));
  return largest;
}

// Corrects rounding errors only. The piece stays free even at a bound, because it determines the
// price of the budget.
void FaceMinimizer::settle_last_free_piece(PiecewiseConstant& x, int j, BudgetState& budget,
                                           const SignalLimits& limits) {
  const double length = x[j].length;
  x[j].value = std::clamp(x[j].value + (limits.budget - x.sum()) / length, 0.0, limits.upper_bound);
  budget.multiplier = -(x[j].slope + limits.total_variation_weight * x.variation_slope(j)) / length;
}

void FaceMinimizer::hold_at_bound(PiecewiseConstant& x, int j, PieceState state, double value) {
  x[j].value = value;
  x[j].state = state;
  // Merge neighbours at the same bound: a zero jump must not keep its sign.
  if (x.size() > 1 && x[x.next(j)].state == state) {
    const int next = x.next(j);
    x.merge_with_previous(next);
    if (next < j) --j;
  }
  if (x.size() > 1 && x[x.previous(j)].state == state) x.merge_with_previous(j);
}

}  // namespace tofsmith

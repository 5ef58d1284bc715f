// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/least_squares_term.hpp"

namespace tofsmith {

struct SignalLimits {
  double total_variation_weight = 0;
  double upper_bound = 0;
  double budget = 0;  ///< infinity without a budget
};

struct BudgetState {
  bool active = false;
  double multiplier = 0;
};

/// Optimizes the free pieces. Jumps with their signs, fixed pieces and an active budget are kept;
/// limits that a step reaches are added.
class FaceMinimizer {
 public:
  explicit FaceMinimizer(const LeastSquaresTerm& term) : term_(term) {}

  /// Moves `x`, with current slopes, to the minimum on its face and on smaller faces reached on the
  /// way. Releases the budget if its multiplier becomes negative. Returns the decrease of the
  /// objective.
  double minimize(PiecewiseConstant& x, BudgetState& budget, const SignalLimits& limits);

  int newton_steps() const { return newton_steps_; }
  void reset_count() { newton_steps_ = 0; }

 private:
  enum class Limit { none, merge, lower_bound, upper_bound, budget };
  struct Block {
    double step = 1;
    Limit limit = Limit::none;
    int piece = -1;
  };

  void assemble(const PiecewiseConstant& x, const SignalLimits& limits);
  void factorize();
  void solve_for_step(const PiecewiseConstant& x, BudgetState& budget, const SignalLimits& limits);
  Block first_block(const PiecewiseConstant& x, const BudgetState& budget,
                    const SignalLimits& limits) const;
  double advance(PiecewiseConstant& x, double step);
  double residual(const PiecewiseConstant& x, const BudgetState& budget,
                  const SignalLimits& limits) const;
  static void settle_last_free_piece(PiecewiseConstant& x, int j, BudgetState& budget,
                                     const SignalLimits& limits);
  static void hold_at_bound(PiecewiseConstant& x, int j, PieceState state, double value);

  const LeastSquaresTerm& term_;
  std::vector<int> free_;
  Eigen::MatrixXd hessian_;  // lower triangle; never shrinks
  Eigen::MatrixXd factor_;   // Cholesky factor at unit diagonal; never shrinks
  Eigen::VectorXd scale_;    // 1 / sqrt(diagonal)
  Eigen::VectorXd gradient_;
  Eigen::VectorXd direction_;
  Eigen::VectorXd pull_;  // Hessian^-1 lengths, for the budget
  Eigen::VectorXd bend_;  // Hessian * direction
  std::vector<double> motion_;
  int newton_steps_ = 0;
};

}  // namespace tofsmith

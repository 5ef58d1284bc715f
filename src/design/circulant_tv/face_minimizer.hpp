// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/piecewise_constant.hpp"

namespace tofsmith {

/// Constraints of a piecewise constant signal and its total-variation weight.
struct SignalLimits {
  double total_variation_weight = 0;
  double upper_bound = 0;
  double budget = 0;  ///< infinity without a budget
};

/// State of the budget constraint and its multiplier per sample.
struct BudgetState {
  bool active = false;
  double multiplier = 0;
};

/// Optimizes the values of the free pieces. Jumps, their signs, pieces fixed at a bound and an
/// active budget are kept until a step reaches a limit, which is then added to the constraints.
class FaceMinimizer {
 public:
  explicit FaceMinimizer(const LeastSquaresTerm& term) : term_(term) {}

  /// Moves `x` to the minimum on its face, and on the smaller faces that are reached on the way.
  /// Slopes of x must be up to date. Releases the budget when its multiplier becomes negative.
  /// @return decrease of the objective
  double minimize(PiecewiseConstant& x, BudgetState& budget, const SignalLimits& limits);

  /// Returns the number of linear systems solved since the last reset.
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
  std::vector<int> free_;       // indices of the free pieces
  Eigen::MatrixXd hessian_;     // of the free pieces, lower triangle; never shrinks
  Eigen::MatrixXd factor_;      // Cholesky factor after scaling to unit diagonal; never shrinks
  Eigen::VectorXd scale_;       // 1 / sqrt of the diagonal
  Eigen::VectorXd gradient_;    // of the objective with respect to the free values
  Eigen::VectorXd direction_;   // Newton step of the free values
  Eigen::VectorXd pull_;        // Hessian^-1 lengths, for the budget
  Eigen::VectorXd bend_;        // Hessian * direction
  std::vector<double> motion_;  // direction of every piece, 0 if fixed
  int newton_steps_ = 0;
};

}  // namespace tofsmith

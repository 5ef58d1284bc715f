// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/piecewise_constant.hpp"

namespace tofsmith {

/// What a piecewise constant signal has to keep to, and the price of its total variation.
struct SignalLimits {
  double total_variation_weight = 0;
  double upper_bound = 0;
  double budget = 0;  ///< infinity where there is none
};

/// Whether the sum of the signal is held at the budget, and what that costs per sample.
struct BudgetState {
  bool active = false;
  double multiplier = 0;
};

/// Best values of the free pieces of a signal, with its jumps, their signs, the pieces held at a
/// bound and an active budget all kept, until a step runs into a limit; then that limit joins them.
class FaceMinimizer {
 public:
  explicit FaceMinimizer(const LeastSquaresTerm& term) : term_(term) {}

  /// Moves `x`, whose slopes are up to date, to the minimum on its face and on the smaller faces
  /// that the way there leads to. Releases the budget when its multiplier turns negative.
  /// @return by how much the objective went down
  double minimize(PiecewiseConstant& x, BudgetState& budget, const SignalLimits& limits);

  /// Linear systems solved so far by this object.
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
  Eigen::MatrixXd hessian_;     // of the free pieces, lower triangle; grows only
  Eigen::MatrixXd factor_;      // its Cholesky factor after scaling to unit diagonal; grows only
  Eigen::VectorXd scale_;       // 1 / sqrt of the diagonal
  Eigen::VectorXd gradient_;    // of the whole objective with respect to the free values
  Eigen::VectorXd direction_;   // Newton step of the free values
  Eigen::VectorXd pull_;        // Hessian^-1 lengths, for the budget
  Eigen::VectorXd bend_;        // Hessian * direction
  std::vector<double> motion_;  // direction of every piece, 0 where held
  int newton_steps_ = 0;
};

}  // namespace tofsmith

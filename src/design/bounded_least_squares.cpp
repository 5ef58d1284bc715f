// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/bounded_least_squares.hpp"

#include <cmath>

#include "tofsmith/core/periodic.hpp"
#include "tofsmith/design/box_budget_projection.hpp"

namespace tofsmith {

Eigen::VectorXd least_squares_within_bounds(const CirculantTvProblem& problem,
                                            const Eigen::VectorXd& start) {
  constexpr int most_steps = 500;
  constexpr double still = 1e-7;  // largest move of a sample, in units of the upper bound
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
  for (int step = 0; step < most_steps; ++step) {
    transform.forward(ahead, half);
    half = kernel.conjugate().cwiseProduct(kernel.cwiseProduct(half) - target);
    transform.inverse(half, gradient);
    Eigen::VectorXd next = ahead - gradient / lipschitz;
    project_on_box_and_budget(next, problem.upper_bound, problem.budget);
    const Eigen::VectorXd move = next - x;
    if (move.cwiseAbs().maxCoeff() < still * problem.upper_bound) return next;
    // Momentum that points uphill is dropped, which keeps the objective from rising in the end.
    if ((ahead - next).dot(move) > 0.0) momentum = 1.0;
    const double grown = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    ahead = next + (momentum - 1.0) / grown * move;
    momentum = grown;
    x = next;
  }
  return x;
}

}  // namespace tofsmith

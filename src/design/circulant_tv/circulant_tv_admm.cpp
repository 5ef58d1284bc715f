// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_admm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/shared/periodic.hpp"
#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/proximal_operators.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

// Conditions for the dual path, rotated so that any jump precedes sample 0.
struct DualConditions {
  Eigen::VectorXd gradient;
  Eigen::VectorXi bound;  // -1 at the lower, +1 at the upper bound, 0 inside
  Eigen::VectorXi jump;   // sign of the jump after the sample
  bool constant = true;
  double weight = 0;
};

DualConditions conditions_at(const CirculantTvProblem& problem, const Eigen::VectorXd& x) {
  const double negligible = 1e-12 * problem.upper_bound;
  const int samples = problem.samples();
  const Eigen::VectorXd gradient = circular_correlation(
      circular_convolution(problem.kernel, x) - problem.target, problem.kernel);
  const auto jump_after = [&](int n) {
    const double jump = x[(n + 1) % samples] - x[n];
    return std::abs(jump) <= negligible ? 0 : jump > 0 ? 1 : -1;
  };
  int origin = 0;
  while (origin < samples && jump_after((origin + samples - 1) % samples) == 0) ++origin;
  origin %= samples;

  DualConditions conditions{Eigen::VectorXd(samples), Eigen::VectorXi(samples),
                            Eigen::VectorXi(samples), true, problem.total_variation_weight};
  for (int k = 0; k < samples; ++k) {
    const int n = (origin + k) % samples;
    conditions.gradient[k] = gradient[n];
    conditions.bound[k] = x[n] <= negligible                         ? -1
                          : x[n] >= problem.upper_bound - negligible ? 1
                                                                     : 0;
    conditions.jump[k] = jump_after(n);
    conditions.constant = conditions.constant && conditions.jump[k] == 0;
  }
  return conditions;
}

struct DualInterval {
  double low, high;

  double confine(double floor, double ceiling) {
    const double miss = std::max({0.0, floor - high, low - ceiling});
    low = std::clamp(low, floor, ceiling);
    high = std::clamp(high, floor, ceiling);
    return miss;
  }
};

// One lap; returns the largest violation of a piece.
double walk(const DualConditions& conditions, double price, DualInterval& dual) {
  const double weight = conditions.weight;
  double worst = 0, of_this_piece = 0;
  for (Eigen::Index k = 0; k < conditions.gradient.size(); ++k) {
    const double step = conditions.gradient[k] + price;
    dual.low = conditions.bound[k] < 0 ? -weight : dual.low + step;
    dual.high = conditions.bound[k] > 0 ? weight : dual.high + step;
    // At the lower bound only the upper end is constrained, and vice versa.
    if (dual.low > dual.high)
      (conditions.bound[k] < 0 ? dual.low : dual.high) =
          conditions.bound[k] < 0 ? dual.high : dual.low;
    of_this_piece += dual.confine(-weight, weight);
    if (conditions.jump[k] != 0) {
      const double required = weight * conditions.jump[k];
      of_this_piece += dual.confine(required, required);
      worst = std::max(worst, of_this_piece);
      of_this_piece = 0;
    }
  }
  return std::max(worst, of_this_piece);
}

double violation_at(const DualConditions& conditions, double price) {
  const double weight = conditions.weight;
  if (!conditions.constant) {
    const double at_jump = weight * conditions.jump[conditions.jump.size() - 1];
    DualInterval dual{at_jump, at_jump};
    return walk(conditions, price, dual);
  }
  DualInterval dual{-weight, weight};
  walk(conditions, price, dual);
  const DualInterval start = dual;
  const double violation = walk(conditions, price, dual);
  return std::max(violation,
                  std::max(std::abs(dual.low - start.low), std::abs(dual.high - start.high)));
}

}  // namespace

OptimalityCertificate certificate(const CirculantTvProblem& problem, const Eigen::VectorXd& x) {
  problem.validate();
  require(x.size() == problem.samples(), "x.size()", x.size(),
          "must equal the problem's samples, " + std::to_string(problem.samples()));
  OptimalityCertificate result;
  const double sum = x.sum();
  result.infeasibility =
      std::max({0.0, -x.minCoeff() / problem.upper_bound, x.maxCoeff() / problem.upper_bound - 1});
  bool budget_binds = false;
  if (problem.budget) {
    const double scale = std::max(*problem.budget, 1e-300);
    result.infeasibility = std::max(result.infeasibility, (sum - *problem.budget) / scale);
    budget_binds = sum >= *problem.budget * (1 - 1e-11);
  }

  const DualConditions conditions = conditions_at(problem, x);
  const auto violation = [&](double price) {
    return violation_at(conditions, price) / conditions.weight;
  };
  result.violation = violation(0);
  if (!budget_binds) return result;

  constexpr double inverse_golden_ratio = 0.61803398874989485;
  double low = 0;
  double high = conditions.gradient.cwiseAbs().maxCoeff() + 2 * conditions.weight;
  double left = high - inverse_golden_ratio * (high - low);
  double right = low + inverse_golden_ratio * (high - low);
  double at_left = violation(left), at_right = violation(right);
  for (int iteration = 0; iteration < 90; ++iteration) {
    for (const auto& [price, value] : {std::pair{left, at_left}, std::pair{right, at_right}})
      if (value < result.violation) {
        result.violation = value;
        result.budget_multiplier = price;
      }
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - inverse_golden_ratio * (high - low);
      at_left = violation(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + inverse_golden_ratio * (high - low);
      at_right = violation(right);
    }
  }
  return result;
}

namespace {

constexpr double over_relaxation = 1.7;
constexpr int steps_per_check = 10;
// Ratio of the residuals that doubles or halves the penalty; convergence requires a final value.
constexpr double imbalance = 5;
constexpr int steps_per_adaptation = 50;
constexpr int last_adaptation = 2000;

class Splitting {
 public:
  Splitting(const CirculantTvProblem& problem, const Eigen::VectorXd& start)
      : problem_(problem), operator_(problem.samples()), z_(start), u_(start * 0.0) {
    operator_.set_kernel(problem.kernel);
    operator_.transform().forward(problem.target, pull_);
    pull_ = pull_.cwiseProduct(operator_.spectrum().conjugate()).eval();
    curvature_ = operator_.spectrum().cwiseAbs2();
    penalty_ = std::max(0.02 * curvature_.maxCoeff(), 1e-300);
  }

  void step() {
    // x = argmin 1/2 |A x - b|^2 + penalty/2 |x - z + u|^2
    operator_.transform().forward(z_ - u_, half_);
    half_ = ((pull_ + penalty_ * half_).array() / (curvature_.array() + penalty_)).matrix().eval();
    operator_.transform().inverse(half_, x_);
    // z = argmin w TV(z) + penalty/2 |x + u - z|^2 on the box and the budget
    z_before_ = z_;
    shifted_ = over_relaxation * x_ + (1 - over_relaxation) * z_ + u_;
    prox_.circular(shifted_, problem_.total_variation_weight / penalty_, ring_dual_, z_);
    project_on_box_and_budget(z_, problem_.upper_bound, problem_.budget);
    u_ = shifted_ - z_;
  }

  double primal_residual() const { return rms(x_ - z_); }
  double dual_residual() const { return rms(z_ - z_before_); }
  void rescale_penalty(double factor) {
    penalty_ *= factor;
    u_ /= factor;
    ring_dual_ /= factor;
  }
  const Eigen::VectorXd& z() const { return z_; }

 private:
  double rms(const Eigen::VectorXd& v) const {
    return v.norm() / (std::sqrt(static_cast<double>(v.size())) * problem_.upper_bound);
  }

  const CirculantTvProblem& problem_;
  CirculantOperator operator_;
  TotalVariationProx prox_;
  double penalty_ = 0, ring_dual_ = 0;
  Eigen::VectorXd x_, z_, u_, z_before_, shifted_, curvature_;
  Eigen::VectorXcd pull_, half_;  // pull_: spectrum of A^T b
};

}  // namespace

void CirculantTvAdmmOptions::validate() const {
  require(max_iterations >= 1, "CirculantTvAdmmOptions::max_iterations", max_iterations,
          "must be >= 1");
  require(std::isfinite(tolerance) && tolerance > 0, "CirculantTvAdmmOptions::tolerance", tolerance,
          "must be finite and > 0");
  require(std::isfinite(certificate_tolerance) && certificate_tolerance > 0,
          "CirculantTvAdmmOptions::certificate_tolerance", certificate_tolerance,
          "must be finite and > 0");
}

CirculantTvResult solve_circulant_tv_by_admm(const CirculantTvProblem& problem,
                                             const CirculantTvAdmmOptions& options,
                                             const std::optional<Eigen::VectorXd>& warm_start) {
  problem.validate();
  options.validate();
  Eigen::VectorXd start = Eigen::VectorXd::Constant(problem.samples(), 0.5 * problem.upper_bound);
  if (warm_start) {
    require(warm_start->size() == problem.samples(), "warm_start.size()", warm_start->size(),
            "must equal the problem's samples, " + std::to_string(problem.samples()));
    require(warm_start->allFinite(), "warm_start", "NaN or infinity", "must be finite");
    start = *warm_start;
  }
  project_on_box_and_budget(start, problem.upper_bound, problem.budget);

  CirculantTvResult result;
  result.method = CirculantTvMethod::admm;
  result.termination = Termination::iteration_limit;
  Splitting splitting(problem, start);
  for (result.iterations = 1; result.iterations <= options.max_iterations; ++result.iterations) {
    splitting.step();
    if (result.iterations % steps_per_check != 0) continue;
    const double primal = splitting.primal_residual(), dual = splitting.dual_residual();
    if (primal < options.tolerance && dual < options.tolerance) {
      result.termination = Termination::stalled;
      break;
    }
    if (result.iterations % steps_per_adaptation == 0 && result.iterations <= last_adaptation) {
      if (primal > imbalance * dual) splitting.rescale_penalty(2);
      if (dual > imbalance * primal) splitting.rescale_penalty(0.5);
    }
  }
  result.iterations = std::min(result.iterations, options.max_iterations);

  result.x = splitting.z();
  result.objective = problem.objective(result.x);
  const OptimalityCertificate judged = certificate(problem, result.x);
  result.certificate = judged.worst();
  result.budget_multiplier = judged.budget_multiplier;
  if (result.certificate <= options.certificate_tolerance)
    result.termination = Termination::converged;
  PiecewiseConstant pieces(problem.samples());
  pieces.take_pieces_of(result.x, problem.upper_bound);
  result.pieces = pieces.size();
  return result;
}

}  // namespace tofsmith

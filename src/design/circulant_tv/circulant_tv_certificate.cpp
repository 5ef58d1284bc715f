// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_certificate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/shared/periodic.hpp"
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

}  // namespace tofsmith

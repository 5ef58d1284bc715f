// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/box_budget_projection.hpp"

#include <algorithm>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

struct Excess {
  double value = 0;
  int moving = 0;
};

Excess excess_at(const Eigen::VectorXd& x, double price, double upper_bound, double budget) {
  Excess excess;
  double sum = 0;
  for (const double value : x) {
    const double lowered = value - price;
    if (lowered >= upper_bound) {
      sum += upper_bound;
    } else if (lowered > 0) {
      sum += lowered;
      ++excess.moving;
    }
  }
  excess.value = sum - budget;
  return excess;
}

// The excess is piecewise linear and decreasing: safeguarded Newton.
double price_of_budget(const Eigen::VectorXd& x, double upper_bound, double budget) {
  double low = 0, high = std::max(x.maxCoeff(), 0.0);
  double price = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const Excess excess = excess_at(x, price, upper_bound, budget);
    if (excess.value == 0) break;
    (excess.value > 0 ? low : high) = price;
    double next = excess.moving > 0 ? price + excess.value / excess.moving : low - 1;
    if (!(next > low && next < high)) next = low + 0.5 * (high - low);
    if (next == price || !(next > low && next < high)) break;
    price = next;
  }
  return price;
}

}  // namespace

double project_on_box_and_budget(Eigen::VectorXd& x, double upper_bound,
                                 const std::optional<double>& budget) {
  require(upper_bound > 0, "upper_bound", upper_bound, "must be > 0");
  if (budget) require(*budget >= 0, "budget", *budget, "must be >= 0");
  double price = 0;
  if (budget && x.size() > 0 && excess_at(x, 0, upper_bound, *budget).value > 0)
    price = price_of_budget(x, upper_bound, *budget);
  x = (x.array() - price).max(0.0).min(upper_bound);
  return price;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/proximal_operators.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void TotalVariationProx::linear(const Eigen::VectorXd& y, double weight, Eigen::VectorXd& x) {
  require(weight >= 0, "weight", weight, "must be >= 0");
  const int size = static_cast<int>(y.size());
  x = y;
  if (size <= 1 || weight == 0) return;

  // The derivative of the cost-to-go of x[n] is piecewise linear and increasing, with knots in
  // [first, last]. Outside, it is the line slope * x + offset of the left or right accumulators.
  knots_.resize(2 * static_cast<std::size_t>(size));
  lower_.resize(static_cast<std::size_t>(size));
  upper_.resize(static_cast<std::size_t>(size));
  int first = size, last = size - 1;

  // The next jump clips the derivative to [-weight, weight]: one new knot per side.
  double left_slope = 1, left_offset = -y[0];
  double right_slope = 1, right_offset = -y[0];
  for (int n = 0; n < size - 1; ++n) {
    while (first <= last && left_slope * knots_[first].position + left_offset <= -weight) {
      left_slope += knots_[first].slope_change;
      left_offset += knots_[first].offset_change;
      ++first;
    }
    lower_[n] = (-weight - left_offset) / left_slope;
    while (last >= first && right_slope * knots_[last].position + right_offset >= weight) {
      right_slope -= knots_[last].slope_change;
      right_offset -= knots_[last].offset_change;
      --last;
    }
    upper_[n] = (weight - right_offset) / right_slope;
    knots_[--first] = {lower_[n], left_slope, left_offset + weight};
    knots_[++last] = {upper_[n], -right_slope, weight - right_offset};
    left_slope = right_slope = 1;
    left_offset = -weight - y[n + 1];
    right_offset = weight - y[n + 1];
  }

  // The derivative vanishes at the last sample; the others follow from the clips.
  while (first <= last && left_slope * knots_[first].position + left_offset <= 0) {
    left_slope += knots_[first].slope_change;
    left_offset += knots_[first].offset_change;
    ++first;
  }
  x[size - 1] = -left_offset / left_slope;
  for (int n = size - 2; n >= 0; --n) x[n] = std::min(std::max(x[n + 1], lower_[n]), upper_[n]);
}

double TotalVariationProx::ring_gap(const Eigen::VectorXd& y, double weight, double dual,
                                    Eigen::VectorXd& x) {
  const Eigen::Index size = y.size();
  tilted_ = y;
  tilted_[0] -= dual;
  tilted_[size - 1] += dual;
  linear(tilted_, weight, x);
  return x[0] - x[size - 1];
}

void TotalVariationProx::circular(const Eigen::VectorXd& y, double weight, double& ring_dual,
                                  Eigen::VectorXd& x) {
  require(weight >= 0, "weight", weight, "must be >= 0");
  if (y.size() <= 2 || weight == 0) {
    ring_dual = 0;
    linear(y, y.size() == 2 ? 2 * weight : weight, x);
    return;
  }
  const double negligible = 1e-15 * y.cwiseAbs().maxCoeff();
  double dual = std::clamp(ring_dual, -weight, weight);
  double gap = ring_gap(y, weight, dual, x);

  // At an end of the range, a gap of the right sign is a true jump.
  double other = dual, other_gap = gap;
  for (double step = 0.02 * weight; std::abs(gap) > negligible; step *= 6) {
    const double end = gap > 0 ? weight : -weight;
    if (dual == end) break;
    other = dual;
    other_gap = gap;
    dual = gap > 0 ? std::min(weight, dual + step) : std::max(-weight, dual - step);
    gap = ring_gap(y, weight, dual, x);
    if ((gap > 0) != (other_gap > 0)) break;
  }

  // Illinois algorithm. The gap is piecewise linear.
  const double width = 4e-16 * weight;
  for (int iteration = 0; iteration < 100; ++iteration) {
    if (std::abs(gap) <= negligible || (gap > 0) == (other_gap > 0)) break;
    if (std::abs(dual - other) <= width) break;
    double next = (dual * other_gap - other * gap) / (other_gap - gap);
    if (iteration % 8 == 7) next = 0.5 * (dual + other);
    if (!(next > std::min(dual, other) && next < std::max(dual, other))) break;
    const double next_gap = ring_gap(y, weight, next, x);
    if ((next_gap > 0) != (gap > 0)) {
      other = dual;
      other_gap = gap;
    } else {
      other_gap *= 0.5;
    }
    dual = next;
    gap = next_gap;
  }
  ring_dual = dual;
}

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

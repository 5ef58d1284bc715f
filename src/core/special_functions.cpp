// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/special_functions.hpp"

#include <cmath>
#include <numbers>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

double chi_square_tail(double value, int degrees) {
  // Q_1(x) = erfc(sqrt(x / 2)), Q_2(x) = exp(-x / 2),
  // Q_(d + 2)(x) = Q_d(x) + (x / 2)^(d / 2) exp(-x / 2) / Gamma(d / 2 + 1).
  const double half = 0.5 * value;
  const bool is_odd = degrees % 2 == 1;
  double tail = is_odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  double term =
      is_odd ? 2.0 * std::sqrt(half / std::numbers::pi) * std::exp(-half) : half * std::exp(-half);
  for (int d = is_odd ? 1 : 2; d < degrees; d += 2) {
    tail += term;
    term *= half / (0.5 * d + 1.0);
  }
  return tail;
}

double chi_square_quantile_of_tail(double rate, int degrees) {
  double low = 0.0, high = degrees;
  while (chi_square_tail(high, degrees) > rate) high *= 2.0;
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) return high;
    (chi_square_tail(middle, degrees) > rate ? low : high) = middle;
  }
}

Eigen::MatrixXd exponential_average(const Eigen::MatrixXd& table, double mean_rows) {
  require(std::isfinite(mean_rows) && mean_rows > 0.0, "mean_rows", mean_rows,
          "must be finite and > 0");
  // Weight of everything beyond a cell, and of its two ends.
  const double beyond = std::exp(-1.0 / mean_rows);
  const double of_next = -mean_rows * std::expm1(-1.0 / mean_rows) - beyond;
  const double of_own = 1.0 - beyond - of_next;
  const Eigen::Index rows = table.rows();
  Eigen::MatrixXd average(rows, table.cols());
  for (Eigen::Index i = 0; i < table.cols(); ++i) {
    const auto step = [&](Eigen::Index n, double after) {
      return of_own * table(n, i) + of_next * table((n + 1) % rows, i) + beyond * after;
    };
    // A pass that starts at 0 covers one period; the contributions of all periods form a geometric
    // series.
    double here = 0.0;
    for (Eigen::Index n = rows - 1; n >= 0; --n) here = step(n, here);
    here /= -std::expm1(-static_cast<double>(rows) / mean_rows);
    for (Eigen::Index n = rows - 1; n >= 0; --n) {
      here = step(n, here);
      average(n, i) = here;
    }
  }
  return average;
}

}  // namespace tofsmith

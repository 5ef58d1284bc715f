// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/exponential_average.hpp"

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

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

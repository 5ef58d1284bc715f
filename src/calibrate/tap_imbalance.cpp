// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/tap_imbalance.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tofsmith {

std::vector<Estimate> tap_imbalance(const Eigen::MatrixXd& table, const Eigen::MatrixXd& error,
                                    std::vector<std::string>& notes) {
  std::vector<Estimate> mismatch;
  for (Eigen::Index i = 0; i + 1 < table.cols(); i += 2) {
    const Eigen::VectorXd a = table.col(i).array() - table.col(i).mean();
    const Eigen::VectorXd b = table.col(i + 1).array() - table.col(i + 1).mean();
    // The noise of `a` adds to its square.
    const double size2 = std::max(1e-300, a.squaredNorm() - error.col(i).squaredNorm());
    const double ratio = -a.dot(b) / size2;
    const double variance =
        error.col(i + 1).cwiseAbs2().mean() + ratio * ratio * error.col(i).cwiseAbs2().mean();
    const double ratio_error = std::sqrt(variance / size2);
    mismatch.push_back(
        {2 * (1 - ratio) / (1 + ratio), 4 / ((1 + ratio) * (1 + ratio)) * ratio_error});
    const auto exposure = static_cast<int>(i / 2) + 1;
    const Estimate& m = mismatch.back();
    if (std::abs(m.value) > 3 * m.standard_error && std::abs(m.value) > 1e-3)
      notes.push_back(fmt::format(
          "taps of exposure {}: the first is {:+.3g} ± {:.1g} % more sensitive than the second",
          exposure, 100 * m.value, 100 * m.standard_error));
    const double left = std::sqrt((b + ratio * a).squaredNorm() / size2);
    if (left > 0.02)
      notes.push_back(fmt::format(
          "taps of exposure {} are not opposite: {:.2g} % of their change does not cancel",
          exposure, 100 * left));
  }
  return mismatch;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/adam.hpp"

#include <cmath>

namespace tofsmith {

void Adam::step(Eigen::MatrixXd& values, const Eigen::MatrixXd& gradient, double rate) {
  if (mean_.size() == 0) {
    mean_ = Eigen::ArrayXXd::Zero(values.rows(), values.cols());
    square_ = mean_;
  }
  mean_power_ *= mean_decay_;
  square_power_ *= square_decay_;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double g = std::isfinite(gradient(i)) ? gradient(i) : 0.0;
    mean_(i) = mean_decay_ * mean_(i) + (1.0 - mean_decay_) * g;
    square_(i) = square_decay_ * square_(i) + (1.0 - square_decay_) * g * g;
    const double deviation = std::sqrt(square_(i) / (1.0 - square_power_));
    values(i) -= rate * (mean_(i) / (1.0 - mean_power_)) / (deviation + 1e-12);
  }
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

/// Stochastic gradient descent whose steps are scaled by running means of the gradient and of its
/// square.
/// @see Kingma and Ba, "Adam: a method for stochastic optimization", ICLR 2015
class Adam {
 public:
  /// Steps `values` against `gradient`, of the same shape at every call; entries that are not
  /// finite count as 0.
  void step(Eigen::MatrixXd& values, const Eigen::MatrixXd& gradient, double rate);

 private:
  static constexpr double mean_decay_ = 0.9, square_decay_ = 0.99;
  Eigen::ArrayXXd mean_, square_;
  double mean_power_ = 1.0, square_power_ = 1.0;
};

}  // namespace tofsmith

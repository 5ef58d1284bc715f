// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

/// Probability that a chi-square variable with `degrees` >= 1 exceeds `value` >= 0.
double chi_square_tail(double value, int degrees);

/// Inverse of chi_square_tail() for `rate` in (0, 1).
double chi_square_quantile_of_tail(double rate, int degrees);

/// Average of periodic columns over exponential delays, exact for linear interpolation between
/// rows:
///   y(n) = integral_0^inf exp(-u / mean) / mean x(n + u) du,  rows modulo their number
/// @param table      (N, columns), N >= 1
/// @param mean_rows  mean delay in rows, > 0
Eigen::MatrixXd exponential_average(const Eigen::MatrixXd& table, double mean_rows);

}  // namespace tofsmith

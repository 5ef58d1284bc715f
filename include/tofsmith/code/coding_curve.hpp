// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

/// The coding curve is the closed path that the vector of K correlations draws as depth runs
/// through the range. Tables are (N, K), one row per depth, end point left out.

/// Length of the coding curve of a table, closed.
double coding_curve_length(const Eigen::MatrixXd& table);

/// Lowest harmonic h such that harmonics 1..h hold `share` of the energy of the non-constant part.
int harmonics_used(const Eigen::MatrixXd& table, double share = 0.99);

/// The curve in its three directions of largest extent (principal axes), (N, 3), for drawing; 0
/// along directions it does not have.
Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table);

/// Number of independent directions of the table, each column taken about its mean: singular values
/// above `tolerance` times the largest.
int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance = 1e-6);

}  // namespace tofsmith

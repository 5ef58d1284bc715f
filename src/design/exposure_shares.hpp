// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// As a share of the integration time.
inline constexpr double min_exposure_share = 0.01;

/// Returns min_exposure_share + (1 - E min_exposure_share) softmax(logits): shares of sum 1 (E).
Eigen::VectorXd shares_of_logits(const Eigen::VectorXd& logits);
/// Inverse of shares_of_logits(), with mean 0; smaller shares count as slightly above the smallest.
Eigen::VectorXd logits_of_shares(const Eigen::VectorXd& shares);
/// Converts a gradient w.r.t. the shares to one w.r.t. the logits.
Eigen::VectorXd pull_back_shares(const Eigen::VectorXd& shares, const Eigen::VectorXd& by_shares);

/// Returns a function of the shares and writes its gradient (E).
using ShareObjective =
    std::function<double(const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares)>;

/// Minimizes a function that decreases with each share, such as the logarithm of a bound, over
/// shares of sum 1 that are at least min_exposure_share. Multiplies each share by a power of its
/// derivative, 1/2 at first: for variances a_e / share_e that add, one step gives the optimum,
/// shares proportional to sqrt(a_e). The result is never worse than the start.
/// @see Fellman, "On the allocation of linear observations", 1974; Torsney, "A moment inequality
///   and monotonicity of an algorithm", 1983
Eigen::VectorXd minimize_over_shares(Eigen::VectorXd shares, const ShareObjective& objective);

}  // namespace tofsmith

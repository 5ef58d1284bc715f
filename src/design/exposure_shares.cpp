// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_shares.hpp"
#include "design/exposure_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "camera/shared/depth_prior.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

double free_share(Eigen::Index exposures) {
  return 1.0 - static_cast<double>(exposures) * min_exposure_share;
}

/// Scales positive shares to the sum 1, with the smallest ones at min_exposure_share.
Eigen::VectorXd with_smallest_shares(Eigen::VectorXd shares) {
  const Eigen::ArrayXd wanted = shares / shares.sum();
  Eigen::Array<bool, Eigen::Dynamic, 1> smallest = wanted < min_exposure_share;
  // Scaling the others may bring more shares to the smallest one.
  for (Eigen::Index round = 0; round < shares.size(); ++round) {
    const double left = 1.0 - min_exposure_share * static_cast<double>(smallest.count());
    const double scale = left / smallest.select(0.0, wanted).sum();
    shares = smallest.select(min_exposure_share, scale * wanted);
    smallest = smallest || shares.array() < min_exposure_share;
  }
  return shares;
}

}  // namespace

Eigen::VectorXd shares_of_logits(const Eigen::VectorXd& logits) {
  const Eigen::ArrayXd weights = (logits.array() - logits.maxCoeff()).exp();
  return min_exposure_share + free_share(logits.size()) / weights.sum() * weights;
}

Eigen::VectorXd logits_of_shares(const Eigen::VectorXd& shares) {
  constexpr double smallest = 1e-4;
  const Eigen::ArrayXd logits = (shares.array() - min_exposure_share).max(smallest).log();
  return logits - logits.mean();
}

Eigen::VectorXd pull_back_shares(const Eigen::VectorXd& shares, const Eigen::VectorXd& by_shares) {
  const Eigen::ArrayXd weights = shares.array() - min_exposure_share;
  const double mean = (weights * by_shares.array()).sum() / free_share(shares.size());
  return weights * (by_shares.array() - mean);
}

Eigen::VectorXd minimize_over_shares(Eigen::VectorXd shares, const ShareObjective& objective) {
  constexpr int max_evaluations = 100;
  constexpr double converged = 1e-4;  // relative change
  constexpr double min_exponent = 0.01, max_exponent = 2.0;
  double exponent = 0.5;
  Eigen::VectorXd gradient, next_gradient;
  double value = objective(shares, gradient);
  for (int i = 0; i < max_evaluations && exponent > min_exponent; ++i) {
    const Eigen::ArrayXd gain = (-gradient).array().max(0.0);
    if (!gain.allFinite() || gain.maxCoeff() <= 0.0) break;
    const Eigen::ArrayXd factor = (gain / gain.maxCoeff()).max(1e-12).pow(exponent);
    Eigen::VectorXd next = with_smallest_shares(shares.array() * factor);
    const double next_value = objective(next, next_gradient);
    if (!(next_value < value)) {
      exponent *= 0.5;
      continue;
    }
    const double change = (next.array() / shares.array()).log().abs().maxCoeff();
    shares = std::move(next);
    value = next_value;
    std::swap(gradient, next_gradient);
    exponent = std::min(max_exponent, 1.5 * exponent);
    if (change < converged) break;
  }
  return shares;
}

}  // namespace tofsmith

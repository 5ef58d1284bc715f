// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_shares.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

Eigen::VectorXd random_vector(int size, std::uint64_t seed) {
  RandomStream random(seed, 1);
  Eigen::VectorXd values(size);
  for (double& value : values) value = 2.0 * random.normal();
  return values;
}

/// Logarithm of the root of a sum of variances that are inversely proportional to the shares.
ShareObjective sum_of_variances(const Eigen::VectorXd& variance) {
  return [variance](const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares) {
    const Eigen::ArrayXd each = variance.array() / shares.array();
    by_shares = -0.5 * each / shares.array() / each.sum();
    return 0.5 * std::log(each.sum());
  };
}

TEST(ExposureShares, HaveTheSumOneAndASmallestValue) {
  for (int exposures = 1; exposures <= 8; ++exposures)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Eigen::VectorXd shares = shares_of_logits(3.0 * random_vector(exposures, seed));
      EXPECT_NEAR(shares.sum(), 1.0, 1e-12);
      EXPECT_GE(shares.minCoeff(), min_exposure_share);
    }
}

TEST(ExposureShares, LogitsGiveTheSameSharesBack) {
  const Eigen::VectorXd shares{{0.4, 0.3, 0.25, 0.05}};
  EXPECT_TRUE(shares_of_logits(logits_of_shares(shares)).isApprox(shares, 1e-12));
  const Eigen::VectorXd smallest{{min_exposure_share, 1.0 - min_exposure_share}};
  EXPECT_TRUE(shares_of_logits(logits_of_shares(smallest)).isApprox(smallest, 1e-3));
}

TEST(ExposureShares, GradientMatchesFiniteDifferences) {
  const Eigen::VectorXd weights = random_vector(5, 3), along = random_vector(5, 4);
  const Eigen::VectorXd logits = 0.3 * random_vector(5, 5);
  constexpr double step = 1e-6;
  const double slope = (weights.dot(shares_of_logits(logits + step * along)) -
                        weights.dot(shares_of_logits(logits - step * along))) /
                       (2.0 * step);
  EXPECT_NEAR(pull_back_shares(shares_of_logits(logits), weights).dot(along), slope, 1e-8);
}

TEST(ExposureShares, AreProportionalToStandardDeviationsThatAdd) {
  const Eigen::VectorXd variance{{1.0, 9.0, 4.0, 0.25}};
  const Eigen::VectorXd shares =
      minimize_over_shares(Eigen::VectorXd::Constant(4, 0.25), sum_of_variances(variance));
  const Eigen::VectorXd expected = variance.cwiseSqrt() / variance.cwiseSqrt().sum();
  EXPECT_TRUE(shares.isApprox(expected, 1e-4)) << shares.transpose();
}

TEST(ExposureShares, OfExposuresWithoutInformationAreTheSmallest) {
  const Eigen::VectorXd variance{{0.0, 1.0, 4.0}};
  const Eigen::VectorXd shares =
      minimize_over_shares(Eigen::VectorXd::Constant(3, 1.0 / 3), sum_of_variances(variance));
  EXPECT_NEAR(shares[0], min_exposure_share, 1e-9);
  EXPECT_NEAR(shares[1], 0.33, 1e-4);
  EXPECT_NEAR(shares.sum(), 1.0, 1e-12);
}

TEST(ExposureShares, StayWhereTheStartIsTheMinimum) {
  const Eigen::VectorXd equal = Eigen::VectorXd::Constant(4, 0.25);
  EXPECT_TRUE(minimize_over_shares(equal, sum_of_variances(Eigen::VectorXd::Ones(4)))
                  .isApprox(equal, 1e-9));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/depth_prior.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "refusal.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

constexpr double infinite = std::numeric_limits<double>::infinity();

const std::vector<double> weights = {0.0, 3.0, 0.0, 1.0, 4.0, 0.0, 0.0};

/// Priors over the whole range and over a part of it.
const std::vector<DepthPrior> priors = {DepthPrior(weights), DepthPrior(weights, 0.13, 0.58),
                                        DepthPrior({}, 0.3, 1.0), DepthPrior({2.0, 1.0}, 0.0, 0.2)};

TEST(DepthPrior, EqualWeightsChangeNothing) {
  for (const std::vector<double>& same : {std::vector<double>{}, {7.0}, {0.1, 0.1, 0.1}}) {
    const DepthPrior prior(same);
    EXPECT_TRUE(prior.is_uniform());
    for (const double x : {0.0, 0.1, 0.7, 0.999}) {
      EXPECT_EQ(prior.quantile(x), x);
      EXPECT_EQ(prior.below(x), x);
      EXPECT_EQ(prior.density(x), 1.0);
    }
  }
}

TEST(DepthPrior, QuantilesInvertTheDistributionAndLieInItsSupport) {
  for (const DepthPrior& prior : priors) {
    double before = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double part = (i + 0.5) / 1000, share = prior.quantile(part);
      EXPECT_NEAR(prior.below(share), part, 1e-12);
      EXPECT_GT(prior.density(share), 0.0) << share;
      EXPECT_GE(share, before);
      before = share;
    }
  }
  for (const double end : {0.0, 1.0 - 1e-16}) {
    EXPECT_GE(priors[0].quantile(end), 1.0 / 7);
    EXPECT_LE(priors[0].quantile(end), 5.0 / 7 + 1e-12);
  }
  EXPECT_LT(priors[2].quantile(1.0 - 1e-16), 1.0);
}

TEST(DepthPrior, DensitiesAreDerivativesOfTheDistributionAndMassesItsSteps) {
  constexpr int parts = 1000;
  for (const DepthPrior& prior : priors) {
    const Eigen::VectorXd masses = prior.masses(parts);
    EXPECT_NEAR(masses.sum(), 1.0, 1e-12);
    for (int i = 0; i < parts; ++i) {
      const double begin = i / 1e3, end = (i + 1) / 1e3, middle = (i + 0.5) / 1e3;
      EXPECT_NEAR(masses[i], prior.below(end) - prior.below(begin), 1e-12);
      EXPECT_LE(masses[i] * parts, prior.max_density() * (1 + 1e-9));
      if (prior.density(begin + 1e-9) == prior.density(end - 1e-9)) {
        EXPECT_NEAR(masses[i] * parts, prior.density(middle), 1e-9) << i;
      }
    }
  }
}

TEST(DepthPrior, MeansAreWeightedByMass) {
  const DepthPrior& prior = priors[0];
  Eigen::VectorXd values(7);
  values << infinite, 1.0, infinite, 10.0, 100.0, infinite, infinite;
  EXPECT_NEAR(mean_over_depths(values, prior.masses(7)), (3 * 1.0 + 10.0 + 4 * 100.0) / 8, 1e-12);
  EXPECT_NEAR(mean_over_depths(Eigen::VectorXd::Constant(24, 5.0), prior.masses(24)), 5.0, 1e-12);
  EXPECT_NEAR(prior.max_density(), 7 * 4.0 / 8, 1e-12);
}

TEST(DepthPrior, NoWeightsOnAnIntervalEqualWeightsOfOneThere) {
  const DepthPrior interval({}, 0.25, 0.75), parts({0.0, 3.0, 3.0, 0.0});
  for (const double x : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999}) {
    EXPECT_NEAR(interval.quantile(x), parts.quantile(x), 1e-12);
    EXPECT_NEAR(interval.below(x), parts.below(x), 1e-12);
  }
}

TEST(DepthPrior, LargestNumbersDoNotOverflow) {
  EXPECT_NEAR(DepthPrior({1e308, 0.0, 1e308}).below(0.5), 0.5, 1e-12);
}

TEST(DepthPrior, OfACameraCoversItsRange) {
  Camera camera = built_in_camera("paper-10f0");
  EXPECT_TRUE(DepthPrior(camera).is_uniform());
  camera.operating.working_distance_m = {0.0, camera.range_m()};
  EXPECT_TRUE(DepthPrior(camera).is_uniform());
  camera.operating.working_distance_m = {0.25 * camera.range_m(), 0.75 * camera.range_m()};
  camera.operating.depths = {1.0, 3.0};
  const DepthPrior prior(camera);
  EXPECT_NEAR(prior.below(0.5), 0.25, 1e-12);
  EXPECT_EQ(prior.below(0.25), 0.0);
  EXPECT_EQ(prior.below(0.75), 1.0);
}

std::string refusal(const std::optional<std::vector<double>>& depths,
                    const std::optional<std::array<double, 2>>& working_distance_m = {}) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.depths = depths;
  camera.operating.working_distance_m = working_distance_m;
  return refusal_of([&] { camera.validate(); });
}

TEST(DepthPrior, IsRejectedIfNoDepthCanBeDrawn) {
  using List = std::vector<double>;
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(List{0.0, 1.0}), "accepted");
  EXPECT_EQ(refusal(List{0.0, 1.0}, {{0.0, 3.0}}), "accepted");
  EXPECT_THAT(refusal(List{}), HasSubstr("operating.depths = []; must list at least one"));
  EXPECT_THAT(refusal(List{0.0, 0.0}),
              HasSubstr("operating.depths = weights that are all 0; must"));
  EXPECT_THAT(refusal(List{1.0, -2.0}), HasSubstr("operating.depths[1] = -2; must be finite"));
  EXPECT_THAT(refusal(List{1.0, no_number}), HasSubstr("operating.depths[1] = nan"));
  EXPECT_THAT(refusal(List{infinite}), HasSubstr("operating.depths[0] = inf"));
  EXPECT_THAT(refusal(List(10001, 1.0)), HasSubstr("operating.depths = 10001 weights; must be at"));
  for (const std::array<double, 2> ends :
       {std::array<double, 2>{3.0, 1.0}, {1.0, 1.0}, {-1.0, 1.0}, {1.0, 11.0}, {no_number, 1.0}})
    EXPECT_THAT(refusal({}, ends), HasSubstr("operating.working_distance_m"));
}

}  // namespace
}  // namespace tofsmith

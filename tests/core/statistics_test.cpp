// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/statistics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/shared/hash.hpp"
#include "core/shared/random.hpp"
#include "core/shared/special_functions.hpp"

namespace tofsmith {

namespace {

TEST(MeanOf, AveragesValuesAndPropagatesErrors) {
  const std::vector<Estimate> estimates{{1.0, 0.3}, {3.0, 0.4}};
  EXPECT_DOUBLE_EQ(mean_of(estimates).value, 2.0);
  EXPECT_DOUBLE_EQ(mean_of(estimates).standard_error, 0.25);
  EXPECT_EQ(mean_of({}).value, 0.0);
  EXPECT_DOUBLE_EQ(geometric_mean_of(estimates).value, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(geometric_mean_of(estimates).standard_error,
                   std::sqrt(3.0) * std::hypot(0.3, 0.4 / 3) / 2);
  EXPECT_EQ(geometric_mean_of(std::vector<Estimate>{{1.0, 0.1}, {0.0, 0.0}}).value, 0.0);
  const std::vector<Estimate> unknown{{1.0, 0.1}, {std::nan(""), 0.0}};
  EXPECT_TRUE(std::isnan(geometric_mean_of(unknown).value));
}

TEST(MedianOf, IsTheMiddle) {
  EXPECT_EQ(median_of({}), 0.0);
  EXPECT_EQ(median_of({4.0}), 4.0);
  EXPECT_EQ(median_of({9.0, 1.0}), 5.0);
  EXPECT_EQ(median_of({9.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median_of({9.0, 1.0, 2.0, 4.0}), 3.0);
}

TEST(QuantileOf, IsAValueOfTheList) {
  EXPECT_EQ(quantile_of({4.0}, 0.7), 4.0);
  EXPECT_EQ(quantile_of({9.0, 1.0, 2.0, 4.0}, 0.0), 1.0);
  EXPECT_EQ(quantile_of({9.0, 1.0, 2.0, 4.0}, 0.5), 2.0);
  EXPECT_EQ(quantile_of({9.0, 1.0, 2.0, 4.0}, 1.0), 9.0);
}

TEST(RunningStatistics, AgreesWithTwoPassesFarFromZero) {
  RunningStatistics statistics;
  RandomStream random(1, 1);
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) {
    values.push_back(1e6 + random.uniform());
    statistics.add(values.back());
  }
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), 100);
  const double variance = (all - all.mean()).square().sum() / 99;
  EXPECT_EQ(statistics.count(), 100);
  EXPECT_NEAR(statistics.mean(), all.mean(), 1e-9);
  EXPECT_NEAR(statistics.variance(), variance, 1e-9);
  EXPECT_NEAR(statistics.standard_error(), std::sqrt(variance / 100), 1e-11);
}

// Test vectors of draft-eastlake-fnv.
TEST(Fnv1a, AgreesWithThePublishedVectors) {
  EXPECT_EQ(fnv1a_64(""), 0xcbf29ce484222325ull);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171f73967e8ull);
  EXPECT_EQ(fnv1a_128_hex(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(fnv1a_128_hex("foobar"), "343e1662793c64bf6f0d3597ba446f18");
}

TEST(ChiSquare, MatchesPublishedQuantiles) {
  EXPECT_NEAR(chi_square_quantile_of_tail(1e-3, 1), 10.828, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(1e-3, 2), 13.816, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(0.05, 3), 7.815, 1e-3);
  EXPECT_NEAR(chi_square_quantile_of_tail(0.01, 60), 88.379, 1e-3);
}

TEST(ChiSquare, QuantileInvertsTail) {
  for (const int degrees : {1, 2, 5, 8, 61})
    for (const double rate : {0.9, 0.1, 1e-3, 1e-9})
      EXPECT_NEAR(chi_square_tail(chi_square_quantile_of_tail(rate, degrees), degrees) / rate, 1.0,
                  1e-9)
          << degrees << " " << rate;
}

}  // namespace

}  // namespace tofsmith

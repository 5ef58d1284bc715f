// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/ziv_zakai.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

using std::numbers::pi;

/// Integrates over shifts for given weights of the harmonics, by brute force.
double confusion_of(const Eigen::VectorXd& power, const Eigen::VectorXd& shares) {
  constexpr int cells = 20000;
  double sum = 0.0;
  for (int j = 0; j < cells; ++j) {
    const double h = 0.5 * (j + 0.5) / cells;
    double squared = 0.0;
    for (Eigen::Index n = 0; n < power.size(); ++n)
      squared +=
          shares[n] * power[n] * std::pow(2 * std::sin(pi * static_cast<double>(n + 1) * h), 2);
    sum += 0.5 * std::erfc(std::sqrt(squared / 8.0));
  }
  return 0.5 * sum / cells;
}

TEST(ZivZakai, IsAQuarterWithoutSignalAndTheDeviationWithMuch) {
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd(), 0.0), 0.25);
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd::Zero(5), infinity), 0.25);
  EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd::Constant(3, 1e-9), infinity), 0.25, 1e-4);
  for (const double power : {1e4, 1e8}) {
    const double sigma = 1.0 / (2 * pi * std::sqrt(power));
    EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd::Constant(1, power), infinity) / sigma,
                std::sqrt(2 / pi), 0.005);
  }
}

TEST(ZivZakai, OfInformationAloneIsTheDeviationUpToAQuarter) {
  for (const double information : {1e3, 1e9})
    EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd(), information) * std::sqrt(information),
                std::sqrt(2 / pi), 0.002);
  EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd(), 1e-6), 0.25, 1e-3);
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd(), infinity), 0.0);
  const Eigen::VectorXd tone = Eigen::VectorXd::Constant(1, 1e6);
  EXPECT_NEAR(ziv_zakai_mae(tone, 1e3) * std::sqrt(1e3), std::sqrt(2 / pi), 0.005)
      << "the smaller of both counts";
}

TEST(ZivZakai, OfOneToneEqualsTheIntegral) {
  for (const double power : {0.1, 1.0, 30.0}) {
    const Eigen::VectorXd one = Eigen::VectorXd::Constant(1, power);
    EXPECT_NEAR(ziv_zakai_mae(one, infinity) / confusion_of(one, Eigen::VectorXd::Ones(1)), 1.0,
                2e-3);
  }
}

TEST(ZivZakai, NoPhaseEstimateBeatsItAndTheBestComesNear) {
  // (cos, sin) of the phase times an amplitude, in unit noise.
  for (const double amplitude : {0.0, 0.3, 1.0, 2.0, 4.0, 10.0}) {
    RandomStream random(5, static_cast<std::uint64_t>(10 * amplitude));
    RunningStatistics error;
    for (int trial = 0; trial < 40000; ++trial) {
      const double turn = 2 * pi * random.uniform();
      const double x = amplitude * std::cos(turn) + random.normal();
      const double y = amplitude * std::sin(turn) + random.normal();
      const double off = std::remainder(std::atan2(y, x) - turn, 2 * pi) / (2 * pi);
      error.add(std::abs(off));
    }
    const double bound =
        ziv_zakai_mae(Eigen::VectorXd::Constant(1, amplitude * amplitude), infinity);
    EXPECT_GE(error.mean() + 4 * error.standard_error(), bound) << amplitude;
    EXPECT_LE(error.mean(), 1.12 * bound) << amplitude;
  }
}

TEST(ZivZakai, IsALowerLimitForAnySharesOfHarmonics) {
  for (std::uint64_t item = 0; item < 6; ++item) {
    RandomStream random(6, item);
    Eigen::VectorXd power(2 + static_cast<int>(6 * random.uniform()));
    const double scale = std::pow(10.0, -1 + 5 * random.uniform());
    for (double& p : power) p = scale * random.uniform();
    const double bound = ziv_zakai_mae(power, infinity);
    double least = 1.0;
    for (int i = 0; i < 40; ++i) {
      Eigen::VectorXd shares(power.size());
      for (double& w : shares) w = std::pow(random.uniform(), 3);
      shares /= shares.sum();
      least = std::min(least, confusion_of(power, shares));
    }
    EXPECT_LT(bound, least * (1 + 1e-3)) << item;
    EXPECT_GT(bound, 0.5 * least) << item;
  }
}

TEST(ZivZakai, MorePowerNeverRaisesItAndManyHarmonicsAreGrouped) {
  Eigen::VectorXd few = Eigen::VectorXd::Constant(90, 3.0);
  Eigen::VectorXd many = Eigen::VectorXd::Constant(400, 3.0);
  EXPECT_LE(ziv_zakai_mae(many, infinity), ziv_zakai_mae(few, infinity) * 1.003);
  EXPECT_GT(ziv_zakai_mae(many, infinity), 0.0);
  EXPECT_LT(ziv_zakai_mae(2.0 * few, infinity), ziv_zakai_mae(few, infinity));
}

}  // namespace
}  // namespace tofsmith

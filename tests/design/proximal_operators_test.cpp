// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/least_squares_term.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"
#include "design/circulant_tv/proximal_operators.hpp"

namespace tofsmith {

namespace {

Eigen::VectorXd random_vector(int size, std::uint32_t index) {
  RandomStream random(7, 1, index);
  Eigen::VectorXd x(size);
  for (double& value : x) value = random.uniform();
  return x;
}

double misfit(const CirculantTvProblem& problem, const Eigen::VectorXd& x) {
  return (circular_convolution(problem.kernel, x) - problem.target).norm();
}

TEST(BoundedLeastSquares, IsFeasibleAndAFixedPointOfProjectedGradientSteps) {
  constexpr int samples = 60;
  const CirculantTvProblem problem{.kernel = random_vector(samples, 0) / samples,
                                   .target = 2.0 * random_vector(samples, 1),
                                   .upper_bound = 3.0,
                                   .budget = 50.0};
  const Eigen::VectorXd x = least_squares_within_bounds(problem, random_vector(samples, 2));
  EXPECT_GE(x.minCoeff(), 0.0);
  EXPECT_LE(x.maxCoeff(), 3.0);
  EXPECT_LE(x.sum(), 50.0 + 1e-9);
  const Eigen::VectorXd residual = circular_convolution(problem.kernel, x) - problem.target;
  Eigen::VectorXd step = x - circular_correlation(residual, problem.kernel);
  project_on_box_and_budget(step, problem.upper_bound, problem.budget);
  EXPECT_LT((step - x).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(BoundedLeastSquares, ReachesAttainableTargetsAndKeepsUndeterminedParts) {
  constexpr int samples = 40;
  // The mean of adjacent samples removes the alternating signal, so x keeps that of its start.
  Eigen::VectorXd kernel = Eigen::VectorXd::Zero(samples);
  kernel[0] = kernel[1] = 0.5;
  const Eigen::VectorXd smooth = Eigen::VectorXd::Constant(samples, 0.5);
  Eigen::VectorXd start(samples);
  for (int n = 0; n < samples; ++n) start[n] = n % 2 == 0 ? 0.6 : 0.2;
  const CirculantTvProblem problem{
      .kernel = kernel, .target = circular_convolution(kernel, smooth), .upper_bound = 1.0};
  const Eigen::VectorXd x = least_squares_within_bounds(problem, start);
  EXPECT_LT(misfit(problem, x), 1e-5);
  EXPECT_NEAR(x[0] - x[1], 0.4, 1e-5);
}

Eigen::VectorXd normal_vector(int size, double scale, RandomStream& random) {
  Eigen::VectorXd x(size);
  for (double& value : x) value = scale * random.normal();
  return x;
}

TEST(BoxBudgetProjection, IsFeasibleAndIdempotent) {
  for (int item = 0; item < 300; ++item) {
    RandomStream random(1, item);
    const double upper_bound = 0.5 + 4 * random.uniform();
    const double budget = 30 * random.uniform();
    Eigen::VectorXd x = normal_vector(40, 5, random);
    project_on_box_and_budget(x, upper_bound, budget);
    EXPECT_GE(x.minCoeff(), 0);
    EXPECT_LE(x.maxCoeff(), upper_bound);
    EXPECT_LE(x.sum(), budget * (1 + 1e-13) + 1e-13);
    Eigen::VectorXd again = x;
    project_on_box_and_budget(again, upper_bound, budget);
    EXPECT_LT((again - x).cwiseAbs().maxCoeff(), 1e-13);
  }
}

// The variational inequality of the projection: <y - p, x - p> <= 0 for all feasible x.
TEST(BoxBudgetProjection, SatisfiesTheVariationalInequality) {
  for (int item = 0; item < 100; ++item) {
    RandomStream random(2, item);
    const Eigen::VectorXd v = normal_vector(12, 2, random);
    Eigen::VectorXd x = v;
    project_on_box_and_budget(x, 1.5, 4.0);
    for (int other = 0; other < 20; ++other) {
      Eigen::VectorXd y(12);
      for (double& value : y) value = 1.5 * random.uniform();
      y *= std::min(1.0, 4.0 / y.sum());
      EXPECT_LE((v - x).dot(y - x), 1e-12);
    }
  }
}

TEST(BoxBudgetProjection, ABudgetThatIsNotExceededHasNoPrice) {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, -1, 3);
  EXPECT_EQ(project_on_box_and_budget(x, 2.0, 100.0), 0.0);
  EXPECT_EQ(x, (Eigen::VectorXd(5) << 0, 0, 1, 2, 2).finished());
}

TEST(BoxBudgetProjection, ABudgetOfZeroGivesZero) {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, -1, 3);
  project_on_box_and_budget(x, 2.0, 0.0);
  EXPECT_LT(x.sum(), 1e-12);
}

TEST(BoxBudgetProjection, RefusesAnEmptySet) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  EXPECT_THROW(project_on_box_and_budget(x, 0.0, {}), std::invalid_argument);
  EXPECT_THROW(project_on_box_and_budget(x, 1.0, -1.0), std::invalid_argument);
}

enum class Ends { open, ring };

Eigen::VectorXd prox(const Eigen::VectorXd& y, double weight, Ends ends) {
  TotalVariationProx map;
  Eigen::VectorXd x;
  double ring_dual = 0;
  if (ends == Ends::open)
    map.linear(y, weight, x);
  else
    map.circular(y, weight, ring_dual, x);
  return x;
}

// Reference: projected gradient on the dual, min 1/2 |y - D^T u|^2 subject to |u| <= weight.
Eigen::VectorXd prox_by_dual(const Eigen::VectorXd& y, double weight, Ends ends) {
  const Eigen::Index size = y.size();
  const Eigen::Index jumps = ends == Ends::ring ? size : size - 1;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(jumps), x = y;
  for (int iteration = 0; iteration < 4000; ++iteration) {
    for (Eigen::Index n = 0; n < jumps; ++n)
      u[n] = std::clamp(u[n] + 0.24 * (x[(n + 1) % size] - x[n]), -weight, weight);
    x = y;
    for (Eigen::Index n = 0; n < jumps; ++n) {
      x[n] += u[n];
      x[(n + 1) % size] -= u[n];
    }
  }
  return x;
}

Eigen::VectorXd random_signal(int size, RandomStream& random) {
  Eigen::VectorXd y(size);
  for (int n = 0; n < size; ++n) y[n] = random.normal() + (n / 7 % 2 == 0 ? 2.0 : 0.0);
  return y;
}

class TotalVariationProxEnds : public testing::TestWithParam<Ends> {};

TEST_P(TotalVariationProxEnds, AgreesWithTheDualForTinySignals) {
  for (int size = 1; size <= 7; ++size)
    for (int item = 0; item < 12; ++item) {
      RandomStream random(1, item, static_cast<std::uint32_t>(size));
      if (GetParam() == Ends::ring && size == 1) continue;
      const Eigen::VectorXd y = random_signal(size, random);
      const double weight = 1.5 * random.uniform();
      EXPECT_LT(
          (prox(y, weight, GetParam()) - prox_by_dual(y, weight, GetParam())).cwiseAbs().maxCoeff(),
          1e-9)
          << "size " << size << " weight " << weight;
    }
}

TEST_P(TotalVariationProxEnds, IsNonexpansive) {
  for (int item = 0; item < 200; ++item) {
    RandomStream random(2, item);
    const Eigen::VectorXd a = random_signal(50, random), b = random_signal(50, random);
    const double weight = 2 * random.uniform();
    EXPECT_LE((prox(a, weight, GetParam()) - prox(b, weight, GetParam())).norm(),
              (a - b).norm() * (1 + 1e-12));
  }
}

TEST_P(TotalVariationProxEnds, KeepsTheMeanAndIsEquivariantToConstants) {
  RandomStream random(3, 0);
  const Eigen::VectorXd y = random_signal(80, random), x = prox(y, 0.7, GetParam());
  EXPECT_NEAR(x.mean(), y.mean(), 1e-12);
  const Eigen::VectorXd moved = prox((y.array() + 3.25).matrix(), 0.7, GetParam());
  EXPECT_LT((moved.array() - 3.25 - x.array()).abs().maxCoeff(), 1e-12);
}

TEST_P(TotalVariationProxEnds, AWeightOfZeroChangesNothingAndALargeOneLeavesTheMean) {
  RandomStream random(5, 0);
  const Eigen::VectorXd y = random_signal(30, random);
  EXPECT_EQ(prox(y, 0, GetParam()), y);
  EXPECT_LT((prox(y, 1e3, GetParam()).array() - y.mean()).abs().maxCoeff(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(OpenAndRing, TotalVariationProxEnds,
                         testing::Values(Ends::open, Ends::ring));

TEST(TotalVariationProx, IsEquivariantToRotationsOfARing) {
  RandomStream random(6, 0);
  const Eigen::VectorXd y = random_signal(97, random);
  const Eigen::VectorXd x = prox(y, 0.8, Ends::ring);
  for (const int shift : {1, 13, 50})
    EXPECT_LT((prox(circular_shift(y, shift), 0.8, Ends::ring) - circular_shift(x, shift))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
}

TEST(TotalVariationProx, RefusesANegativeWeight) {
  EXPECT_THROW(prox(Eigen::VectorXd::Zero(4), -1, Ends::ring), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "circulant_tv_instances.hpp"
#include "design/circulant_tv/box_budget_projection.hpp"
#include "design/circulant_tv/total_variation_prox.hpp"

namespace tofsmith {
namespace {

// With A = I the solution is known in closed form.
CirculantTvProblem denoising_problem(double upper_bound, std::optional<double> budget) {
  CirculantTvProblem problem;
  RandomStream random(1, 0);
  problem.kernel = Eigen::VectorXd::Unit(60, 0);
  problem.target.resize(60);
  for (int n = 0; n < 60; ++n) problem.target[n] = random.normal() + (n < 30 ? 2 : -1);
  problem.total_variation_weight = 0.8;
  problem.upper_bound = upper_bound;
  problem.budget = budget;
  return problem;
}

Eigen::VectorXd denoised(const CirculantTvProblem& problem, double* price = nullptr) {
  TotalVariationProx prox;
  Eigen::VectorXd x;
  double ring_dual = 0;
  prox.circular(problem.target, problem.total_variation_weight, ring_dual, x);
  const double paid = project_on_box_and_budget(x, problem.upper_bound, problem.budget);
  if (price) *price = paid;
  return x;
}

TEST(CirculantTvCertificate, AcceptsTheKnownSolution) {
  for (const double upper_bound : {1.5, 100.0}) {
    const CirculantTvProblem free = denoising_problem(upper_bound, {});
    EXPECT_LT(certificate(free, denoised(free)).worst(), 1e-12);
    const CirculantTvProblem tight = denoising_problem(upper_bound, 20.0);
    double price = 0;
    const OptimalityCertificate judged = certificate(tight, denoised(tight, &price));
    EXPECT_LT(judged.worst(), 1e-11);
    EXPECT_NEAR(judged.budget_multiplier, price, 1e-10);
  }
}

TEST(CirculantTvCertificate, AcceptsAConstantIfTheWeightIsLarge) {
  CirculantTvProblem problem = denoising_problem(100, {});
  problem.total_variation_weight = 100;
  const double mean = problem.target.mean();
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Constant(60, mean)).worst(), 1e-12);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, mean + 0.1)).violation,
              60 * 0.1 / 100, 1e-9);
  // At a bound, only moves back into the box count.
  problem.upper_bound = 0.5 * mean;
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Constant(60, 0.5 * mean)).worst(), 1e-12);
  problem.target = -problem.target;
  EXPECT_LT(certificate(problem, Eigen::VectorXd::Zero(60)).worst(), 1e-12);
  EXPECT_GT(certificate(problem, Eigen::VectorXd::Constant(60, 0.5 * mean)).violation, 0.1);
}

TEST(CirculantTvCertificate, RejectsSuboptimalPoints) {
  const CirculantTvProblem problem = denoising_problem(1.5, 20.0);
  const Eigen::VectorXd x = denoised(problem);
  for (int n = 0; n < 60; ++n)
    for (const double change : {-1e-4, 1e-4}) {
      Eigen::VectorXd moved = x;
      moved[n] += change;
      EXPECT_GT(certificate(problem, moved).worst(), 1e-6) << "sample " << n << " " << change;
    }
  EXPECT_GT(certificate(problem, 0.99 * x).violation, 1e-3);
}

TEST(CirculantTvCertificate, ReportsInfeasibility) {
  const CirculantTvProblem problem = denoising_problem(1.5, 20.0);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, 1.0)).infeasibility, 2.0, 1e-12);
  EXPECT_NEAR(certificate(problem, Eigen::VectorXd::Constant(60, -0.15)).infeasibility, 0.1, 1e-12);
}

// Moving a piece or an interval may not gain more than the certificate states.
TEST(CirculantTvCertificate, BoundsTheGainOfAnyIntervalMove) {
  for (int item = 0; item < 40; ++item) {
    RandomStream random(2, item);
    const CirculantTvProblem problem = test::random_circulant_tv({40, 2e-5, item % 2 == 1}, random);
    Eigen::VectorXd x(40);
    for (double& value : x) value = std::floor(3 * random.uniform()) / 2 * problem.upper_bound;
    CirculantTvProblem unlimited = problem;
    unlimited.budget.reset();
    const double violation = certificate(unlimited, x).violation;
    const double height = 1e-7 * problem.upper_bound;
    double best_gain = 0;
    for (int first = 0; first < 40; ++first)
      for (int length = 1; length <= 40; ++length)
        for (const int sign : {1, -1}) {
          Eigen::VectorXd moved = x;
          for (int k = 0; k < length; ++k) moved[(first + k) % 40] += sign * height;
          if (moved.minCoeff() < 0 || moved.maxCoeff() > problem.upper_bound) continue;
          best_gain = std::max(best_gain, problem.objective(x) - problem.objective(moved));
        }
    const double gain = best_gain / (height * problem.total_variation_weight);
    // An interval may span several pieces, each with its own violation.
    EXPECT_LE(gain, violation * 40 + 1e-3);
    EXPECT_GT(violation, 0.1);
  }
}

TEST(CirculantTvCertificate, RefusesAnotherLength) {
  EXPECT_THROW(certificate(denoising_problem(1, {}), Eigen::VectorXd::Zero(59)),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

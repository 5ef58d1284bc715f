// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/least_squares_term.hpp"

#include <gtest/gtest.h>

#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"
#include "design/circulant_tv/box_budget_projection.hpp"

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/box_budget_projection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/shared/bounded_quadratic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

/// Returns h = B^T B with a random B of `rows` rows; singular below three.
Quadratic random_quadratic(RandomStream& random, int rows) {
  Quadratic q;
  for (int r = 0; r < rows; ++r) {
    const Quadratic::Vector row{random.normal(), random.normal(), random.normal()};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) q.h[i][j] += row[i] * row[j];
    const double target = random.normal();  // g in the range of h: bounded below
    for (std::size_t i = 0; i < 3; ++i) q.g[i] += row[i] * target;
  }
  return q;
}

TEST(BoundedQuadratic, MinimumMeetsTheOptimalityConditions) {
  RandomStream random(1, 0);
  for (int trial = 0; trial < 3000; ++trial) {
    const int unknowns = 2 + trial % 2;
    const Quadratic q = random_quadratic(random, 2 + trial % 3);
    const BoundedMinimum least = minimize_bounded(q, unknowns);
    EXPECT_NEAR(least.value, q.at(least.x), 1e-12);
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_GE(least.x[at], 0.0);
      if (i >= unknowns) {
        EXPECT_EQ(least.x[at], 0.0);
        continue;
      }
      double slope = -q.g[at];
      for (std::size_t j = 0; j < 3; ++j) slope += q.h[at][j] * least.x[j];
      EXPECT_GE(slope, -1e-7) << trial;
      EXPECT_NEAR(slope * least.x[at], 0.0, 1e-7 * (1 + least.x[at])) << trial;
    }
  }
}

TEST(BoundedQuadratic, SchurComplementIsTheInverseOfABlockOfTheInverse) {
  RandomStream random(2, 0);
  for (int trial = 0; trial < 300; ++trial) {
    const Quadratic q = random_quadratic(random, 5);
    Eigen::Matrix3d h;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        h(i, j) = q.h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    const Eigen::Matrix3d inverse = h.inverse();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(left_of(q, i) * inverse(i, i), 1.0, 1e-8);
  }
  Quadratic without_third = random_quadratic(random, 4);
  for (std::size_t i = 0; i < 3; ++i) without_third.h[2][i] = without_third.h[i][2] = 0.0;
  const auto& h = without_third.h;
  EXPECT_NEAR(left_of(without_third, 0), h[0][0] - h[0][1] * h[0][1] / h[1][1], 1e-12);
  EXPECT_NEAR(left_of(without_third, 1), h[1][1] - h[0][1] * h[0][1] / h[0][0], 1e-12);
}

}  // namespace
}  // namespace tofsmith

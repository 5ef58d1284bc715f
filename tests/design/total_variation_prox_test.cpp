// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/total_variation_prox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

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

TEST_P(TotalVariationProxEnds, IsEquivariantToConstants) {
  RandomStream random(3, 0);
  const Eigen::VectorXd y = random_signal(80, random);
  const Eigen::VectorXd moved = prox((y.array() + 3.25).matrix(), 0.7, GetParam());
  EXPECT_LT((moved.array() - 3.25 - prox(y, 0.7, GetParam()).array()).abs().maxCoeff(), 1e-12);
}

TEST_P(TotalVariationProxEnds, KeepsTheMean) {
  RandomStream random(4, 0);
  const Eigen::VectorXd y = random_signal(80, random);
  EXPECT_NEAR(prox(y, 0.7, GetParam()).mean(), y.mean(), 1e-12);
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

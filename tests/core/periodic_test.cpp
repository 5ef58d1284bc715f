// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/periodic.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace tofsmith {
namespace {

Eigen::VectorXd direct_correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index size = a.size();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size);
  for (Eigen::Index z = 0; z < size; ++z)
    for (Eigen::Index n = 0; n < size; ++n) result[z] += a[n] * b[(n - z + size) % size];
  return result;
}

class PeriodicLength : public testing::TestWithParam<int> {};

TEST_P(PeriodicLength, InverseUndoesForward) {
  const PeriodicTransform transform(GetParam());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(GetParam());
  Eigen::VectorXcd spectrum;
  Eigen::VectorXd back;
  transform.forward(x, spectrum);
  transform.inverse(spectrum, back);
  EXPECT_LT((back - x).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(PeriodicLength, CorrelationAgreesWithItsDefinition) {
  const Eigen::VectorXd a = Eigen::VectorXd::Random(GetParam());
  const Eigen::VectorXd b = Eigen::VectorXd::Random(GetParam());
  EXPECT_LT((circular_correlation(a, b) - direct_correlation(a, b)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST_P(PeriodicLength, CorrelationIsTheAdjointOfConvolution) {
  const Eigen::VectorXd kernel = Eigen::VectorXd::Random(GetParam());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(GetParam());
  const Eigen::VectorXd y = Eigen::VectorXd::Random(GetParam());
  EXPECT_NEAR(circular_convolution(kernel, x).dot(y), x.dot(circular_correlation(y, kernel)),
              1e-10);
}

INSTANTIATE_TEST_SUITE_P(EvenOddPrimeAndTiny, PeriodicLength,
                         testing::Values(1, 2, 3, 60, 97, 240));

TEST(Periodic, OneTransformIsUsableByManyThreads) {
  const PeriodicTransform transform(240);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(240);
  Eigen::VectorXcd expected;
  transform.forward(x, expected);
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      Eigen::VectorXcd spectrum;
      for (int i = 0; i < 2000; ++i) {
        transform.forward(x, spectrum);
        wrong += spectrum != expected;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Periodic, ShiftMovesTheCorrelationPeak) {
  const Eigen::VectorXd x = Eigen::VectorXd::Random(50);
  Eigen::Index peak = 0;
  circular_correlation(circular_shift(x, 7), x).maxCoeff(&peak);
  EXPECT_EQ(peak, 7);
}

TEST(Periodic, TotalVariationClosesTheCircle) {
  Eigen::VectorXd x(4);
  x << 0, 1, 1, 0.5;
  EXPECT_DOUBLE_EQ(circular_total_variation(x), 2.0);
}

TEST(Periodic, RejectsSignalsOfDifferentLength) {
  EXPECT_THROW(circular_convolution(Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(4)),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

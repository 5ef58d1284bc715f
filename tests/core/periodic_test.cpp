// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/periodic.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "core/shared/random.hpp"

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

Image<float> random_image(int height, int width, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  Image<float> image(height, width);
  for (float& value : image.pixels) value = static_cast<float>(random.uniform());
  return image;
}

TEST(PaddedConvolution, EqualsTheSumOverNeighbours) {
  for (const auto& [height, width, up, left] :
       {std::array{7, 9, 2, 3}, {5, 4, 6, 9}, {1, 6, 1, 2}, {1, 1, 3, 0}, {12, 3, 0, 2}}) {
    const Image<float> image = random_image(height, width, 1);
    const Image<float> kernel = random_image(2 * up + 1, 2 * left + 1, 2);
    const Image<float> found = PaddedConvolution(kernel, height, width).apply(image);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) {
        double sum = 0.0;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            if (std::abs(v - y) <= up && std::abs(u - x) <= left)
              sum += static_cast<double>(kernel(up + v - y, left + u - x)) *
                     static_cast<double>(image(y, x));
        EXPECT_NEAR(found(v, u), sum, 1e-5) << height << " x " << width;
      }
  }
}

TEST(PaddedConvolution, RejectsKernelsOfEvenSize) {
  EXPECT_THROW(PaddedConvolution(Image<float>(2, 3), 4, 4), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/trial_kernel.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "each_target.hpp"

namespace tofsmith {
namespace {

std::size_t lanes_of(std::int64_t target) {
  if (target == HWY_SCALAR) return 1;
  if (target == HWY_AVX3) return 8;
  return target == HWY_AVX2 ? 4 : 2;
}

TEST(TrialKernel, SumsErrorsInVectorOrderWithEveryHighwayVersion) {
  constexpr std::size_t pairs = 8;
  std::array<double, 2 * pairs> true_bin{}, decoded_bin{};
  std::array<double, pairs> pair_sum{};
  for (std::size_t i = 0; i < pairs; ++i) {  // values whose sum depends on the order
    const double a = std::exp(1.7 * static_cast<double>(i)) / 3e4, b = 0.1 * a;
    decoded_bin[2 * i] = a;
    decoded_bin[2 * i + 1] = b;
    pair_sum[i] = a + b;
  }
  for_each_target([&](std::int64_t target) {
    const std::size_t lanes = lanes_of(target);
    std::array<double, pairs> sum{};
    for (std::size_t i = 0; i < pairs; ++i) sum[i % lanes] += pair_sum[i];
    for (std::size_t half = lanes / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) sum[i] += sum[i + half];
    const TileSums sums = sum_errors(true_bin.data(), decoded_bin.data(), 2 * pairs, 1000.0, 1e9);
    EXPECT_EQ(sums.linear.sum, sum[0]);
  });
}

}  // namespace
}  // namespace tofsmith

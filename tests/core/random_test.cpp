// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

TEST(RandomStream, DependsOnSeedItemAndTrialOnly) {
  RandomStream a(7, 3, 5), b(7, 3, 5);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a(), b());
  const auto first = [](RandomStream s) { return s(); };
  EXPECT_NE(first({7, 3, 5}), first({8, 3, 5}));
  EXPECT_NE(first({7, 3, 5}), first({7, 4, 5}));
  EXPECT_NE(first({7, 3, 5}), first({7, 3, 6}));
  EXPECT_NE(first({7, 3, 5}), first({7, (std::uint64_t{1} << 32) + 3, 5}));
}

TEST(RandomStream, MatchesThePublishedPhiloxVector) {
  // From Random123's kat_vectors: philox4x32-10, zero counter and key.
  RandomStream stream(0, 0, 0);
  EXPECT_EQ(stream(), 0x6627e8d5u);
  EXPECT_EQ(stream(), 0xe169c58du);
  EXPECT_EQ(stream(), 0xbc57ac4cu);
  EXPECT_EQ(stream(), 0x9b00dbd8u);
}

TEST(RandomStream, NormalHasTheMomentsOfANormal) {
  RandomStream stream(1, 0);
  RunningStatistics mean, square, fourth;
  for (int i = 0; i < 200000; ++i) {
    const double x = stream.normal();
    mean.add(x);
    square.add(x * x);
    fourth.add(x * x * x * x);
  }
  EXPECT_NEAR(mean.mean(), 0.0, 4 * mean.standard_error());
  EXPECT_NEAR(square.mean(), 1.0, 4 * square.standard_error());
  EXPECT_NEAR(fourth.mean(), 3.0, 4 * fourth.standard_error());
}

class PoissonMean : public testing::TestWithParam<double> {};

TEST_P(PoissonMean, MeanEqualsVariance) {
  RandomStream stream(2, 0);
  RunningStatistics counts, squares;
  for (int i = 0; i < 50000; ++i) {
    const double x = stream.poisson(GetParam());
    EXPECT_EQ(x, std::floor(x));
    counts.add(x);
    squares.add((x - GetParam()) * (x - GetParam()));
  }
  EXPECT_NEAR(counts.mean(), GetParam(), 4 * counts.standard_error());
  EXPECT_NEAR(squares.mean(), GetParam(), 4 * squares.standard_error());
}

INSTANTIATE_TEST_SUITE_P(SmallToHuge, PoissonMean, testing::Values(0.3, 5.0, 40.0, 3e4, 9e8, 5e9));

TEST(RandomStream, PoissonOfMeanZeroIsZero) {
  RandomStream stream(2, 0);
  EXPECT_EQ(stream.poisson(0.0), 0.0);
  EXPECT_EQ(stream.poisson(-3.0), 0.0);
}

TEST(Parallel, BlocksCoverEveryIndexOnceForAnyThreadCount) {
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    std::vector<int> seen(1003, 0);
    parallel_for_blocks(1003, 64, [&](IndexRange range) {
      EXPECT_EQ(range.begin % 64, 0);
      for (auto i = range.begin; i < range.end; ++i) ++seen[static_cast<std::size_t>(i)];
    });
    for (const int count : seen) EXPECT_EQ(count, 1);
  }
}

TEST(Parallel, UsesMoreThreadsThanCoresOnRequest) {
  const std::vector<std::string> features = build_info().features;
  if (std::ranges::find(features, "TBB") == features.end())
    GTEST_SKIP() << "all work is done in one thread";
  const int threads = static_cast<int>(std::thread::hardware_concurrency()) + 3;
  const ThreadLimit limit(threads);
  std::mutex mutex;
  std::condition_variable all_there;
  int there = 0;
  parallel_for(threads, [&](std::int64_t) {  // all threads must run at once
    std::unique_lock lock(mutex);
    if (++there == threads) all_there.notify_all();
    all_there.wait_for(lock, std::chrono::seconds(20), [&] { return there == threads; });
    EXPECT_EQ(there, threads);
  });
}

TEST(Statistics, GeometricMeanPropagatesRelativeErrors) {
  const Estimate estimates[] = {{1.0, 0.1}, {100.0, 10.0}};
  const Estimate mean = geometric_mean_of(estimates);
  EXPECT_NEAR(mean.value, 10.0, 1e-12);
  EXPECT_NEAR(mean.standard_error, 10.0 * std::sqrt(0.02) / 2, 1e-12);
}

TEST(Statistics, GeometricMeanOfNaNIsNaN) {
  const Estimate estimates[] = {{1.0, 0.1}, {std::nan(""), 0.0}};
  EXPECT_TRUE(std::isnan(geometric_mean_of(estimates).value));
  const Estimate with_zero[] = {{1.0, 0.1}, {0.0, 0.0}};
  EXPECT_EQ(geometric_mean_of(with_zero).value, 0.0);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/random.hpp"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "core/shared/random_tile.hpp"
#include "each_target.hpp"
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

TEST(RandomStream, PoissonCountsAreIntegersWithMeanEqualToVariance) {
  for (const double mean : {0.3, 5.0, 40.0, 3e4, 9e8, 5e9}) {
    RandomStream stream(2, 0);
    RunningStatistics counts, squares;
    for (int i = 0; i < 50000; ++i) {
      const double x = stream.poisson(mean);
      EXPECT_EQ(x, std::floor(x));
      counts.add(x);
      squares.add((x - mean) * (x - mean));
    }
    EXPECT_NEAR(counts.mean(), mean, 4 * counts.standard_error()) << mean;
    EXPECT_NEAR(squares.mean(), mean, 4 * squares.standard_error()) << mean;
  }
}

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

struct Words {
  alignas(64) std::uint32_t at[4 * trials_per_tile];
};

TEST(RandomTile, WordsMatchRandom123) {
  const TrialStreams streams[] = {
      {0, 0, 0}, {0x0123456789abcdefull, 0xfedcba9876543210ull, 0xffffff00u}, {~0ull, ~0ull, 77}};
  for_each_target([&] {
    for (const TrialStreams& s : streams)
      for (const std::uint32_t block : {0u, 1u, 0xffffffffu})
        for (const int trials : {1, 16, 250, trials_per_tile}) {
          Words words;
          draw_words(s, block, trials, words.at);
          for (int i = 0; i < trials; ++i) {
            const r123::Philox4x32::ctr_type counter = {
                {block, s.first_trial + static_cast<std::uint32_t>(i),
                 static_cast<std::uint32_t>(s.work_item),
                 static_cast<std::uint32_t>(s.work_item >> 32)}};
            const r123::Philox4x32::key_type key = {
                {static_cast<std::uint32_t>(s.seed), static_cast<std::uint32_t>(s.seed >> 32)}};
            const auto expected = r123::Philox4x32()(counter, key);
            for (int w = 0; w < 4; ++w)
              ASSERT_EQ(words.at[w * trials_per_tile + i], expected[static_cast<std::size_t>(w)])
                  << "word " << w << " of trial " << i;
          }
        }
  });
}

TEST(RandomTile, WordsMatchThoseOfAStream) {
  Words words;
  draw_words({7, 3, 40}, 0, 16, words.at);
  RandomStream stream(7, 3, 45);
  for (int w = 0; w < 4; ++w) EXPECT_EQ(words.at[w * trials_per_tile + 5], stream());
}

struct Normals {
  alignas(64) float first[trials_per_tile];
  alignas(64) float second[trials_per_tile];
};

TEST(RandomTile, NormalsAreNormalAndIndependent) {
  for_each_target([] {
    RunningStatistics first, square, fourth, product;
    std::vector<double> values;
    for (std::uint32_t tile = 0; tile < 200; ++tile) {
      Words words;
      Normals n;
      draw_words({5, 1, tile * trials_per_tile}, 0, trials_per_tile, words.at);
      normals_of(words.at, words.at + trials_per_tile, trials_per_tile, n.first, n.second);
      for (int i = 0; i < trials_per_tile; ++i) {
        for (const double x : {double{n.first[i]}, double{n.second[i]}}) {
          first.add(x);
          square.add(x * x);
          fourth.add(x * x * x * x);
          values.push_back(x);
        }
        product.add(double{n.first[i]} * n.second[i]);
      }
    }
    EXPECT_NEAR(first.mean(), 0.0, 4 * first.standard_error());
    EXPECT_NEAR(square.mean(), 1.0, 4 * square.standard_error());
    EXPECT_NEAR(fourth.mean(), 3.0, 4 * fourth.standard_error());
    EXPECT_NEAR(product.mean(), 0.0, 4 * product.standard_error());
    // Kolmogorov-Smirnov test: exceeds 1.95 / sqrt(n) with probability 0.001.
    std::sort(values.begin(), values.end());
    const auto count = static_cast<double>(values.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
      distance = std::max(distance, std::abs(0.5 * std::erfc(-values[i] * std::sqrt(0.5)) -
                                             (static_cast<double>(i) + 0.5) / count));
    EXPECT_LT(distance, 1.95 / std::sqrt(count));
  });
}

TEST(RandomTile, NormalsHaveLongTailsAndMatchTheFormula) {
  Words words{};
  const std::array<std::uint32_t, 6> radius = {0u, 2u, 0x7fffffffu, 0xffffffffu, 1u << 20, 12345u};
  for (std::size_t i = 0; i < radius.size(); ++i) {
    words.at[i] = radius[i];
    words.at[trials_per_tile + i] = static_cast<std::uint32_t>(i) * 0x2fffffffu;
  }
  for_each_target([&] {
    Normals n;
    normals_of(words.at, words.at + trials_per_tile, 16, n.first, n.second);
    EXPECT_NEAR(std::hypot(n.first[0], n.second[0]), 6.66, 0.01);
    for (std::size_t i = 0; i < radius.size(); ++i) {
      const double u = (static_cast<double>(radius[i] >> 1) + 0.5) * 0x1p-31;
      const double length = std::sqrt(std::max(0.0, -2 * std::log(u)));
      EXPECT_NEAR(std::hypot(n.first[i], n.second[i]), length, 1e-6 + 1e-3 * (radius[i] > 1u << 31))
          << i;
    }
  });
}

/// Compares counts with the Poisson distribution, in classes of at least ten expected counts.
/// @returns the deviation of chi-square from its mean in standard deviations (Wilson-Hilferty)
double chi_square_deviation(const std::vector<double>& counts, double mean) {
  const auto total = static_cast<double>(counts.size());
  const double sigma = std::sqrt(mean);
  const double width = std::max(1.0, std::floor(sigma / 8));
  std::map<double, double> observed;
  for (const double k : counts) observed[std::floor(k / width)] += 1;
  const auto probability = [&](double k) {
    return std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
  };
  double chi_square = 0.0, classes = 0.0, expected = 0.0, seen = 0.0;
  const double first = std::floor(std::max(0.0, mean - 8 * sigma - 10) / width);
  const double last = std::floor((mean + 8 * sigma + 20) / width);
  const auto close = [&] {
    chi_square += (seen - expected) * (seen - expected) / expected;
    classes += 1;
    expected = seen = 0.0;
  };
  double left = total;
  for (double c = first; c <= last; ++c) {
    for (double k = c * width; k < (c + 1) * width; ++k) expected += total * probability(k);
    const auto at = observed.find(c);
    if (at != observed.end()) seen += at->second;
    left -= at != observed.end() ? at->second : 0.0;
    if (expected >= 10.0) close();
  }
  if (expected > 0.5) close();
  EXPECT_LE(left, 1.0) << "counts far out";
  const double f = classes - 1;
  return (std::cbrt(chi_square / f) - (1 - 2 / (9 * f))) / std::sqrt(2 / (9 * f));
}

std::vector<double> poisson_counts(double mean, int tiles) {
  std::vector<double> means(trials_per_tile, mean), counts, tile(trials_per_tile);
  for (int t = 0; t < tiles; ++t) {
    draw_poisson({11, 2, static_cast<std::uint32_t>(t * trials_per_tile)}, 3, trials_per_tile,
                 means.data(), tile.data());
    counts.insert(counts.end(), tile.begin(), tile.end());
  }
  return counts;
}

class PoissonTile : public testing::TestWithParam<double> {};

TEST_P(PoissonTile, HasThePoissonDistribution) {
  const double mean = GetParam();
  const std::vector<double> counts = poisson_counts(mean, 800);
  RunningStatistics moments, squares;
  for (const double k : counts) {
    moments.add(k);
    squares.add((k - mean) * (k - mean));
  }
  EXPECT_NEAR(moments.mean(), mean, 4 * moments.standard_error());
  EXPECT_NEAR(squares.mean(), mean, 4 * squares.standard_error());
  EXPECT_LT(chi_square_deviation(counts, mean), 4.0);
}

// The scalar generator has the same distribution.
TEST_P(PoissonTile, CountsOfAStreamHaveTheSameDistribution) {
  RandomStream stream(11, 2);
  std::vector<double> counts(std::size_t{200} * trials_per_tile);
  for (double& count : counts) count = stream.poisson(GetParam());
  EXPECT_LT(chi_square_deviation(counts, GetParam()), 4.0);
}

INSTANTIATE_TEST_SUITE_P(FromRareToPlenty, PoissonTile,
                         testing::Values(0.1, 1.0, 4.0, 9.99, 10.0, 12.5, 30.0, 100.0, 1e3, 3e4,
                                         1e6, 1e7));

TEST(PoissonTile, DependsOnTheTrialOnly) {
  std::vector<double> mean(trials_per_tile), whole(trials_per_tile), part(trials_per_tile);
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5 * static_cast<double>(i);
  draw_poisson({4, 9, 1000}, 5, trials_per_tile, mean.data(), whole.data());
  draw_poisson({4, 9, 1048}, 5, 96, mean.data() + 48, part.data());
  for (std::size_t i = 0; i < 96; ++i) EXPECT_EQ(part[i], whole[48 + i]);
  EXPECT_EQ(whole[0], 0.0);  // mean 0
  for_each_target([&] {
    std::vector<double> again(trials_per_tile);
    draw_poisson({4, 9, 1000}, 5, trials_per_tile, mean.data(), again.data());
    EXPECT_EQ(again, whole);
  });
}

}  // namespace

}  // namespace tofsmith

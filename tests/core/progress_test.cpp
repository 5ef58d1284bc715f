// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/shared/shared_progress.hpp"
#include "core/shared/working_threads.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

// As in a training set: the disk is full for one scene while another is captured.
TEST(ParallelFor, InnerWorkIsCompleteAlthoughAnotherTaskFails) {
  constexpr std::int64_t inner = 1000;
  using namespace std::chrono_literals;
  std::atomic<int> begun{0};
  std::atomic<std::int64_t> done{-1};
  const auto work = [&](std::int64_t) {
    if (begun++ == 0) {  // the first task fails once the second has begun
      for (int i = 0; i < 1000 && begun < 2; ++i) std::this_thread::sleep_for(1ms);
      throw std::runtime_error("disk full");
    }
    std::this_thread::sleep_for(50ms);
    std::atomic<std::int64_t> count{0};
    parallel_for(inner, [&](std::int64_t) { ++count; });
    done = count.load();
  };
  EXPECT_THROW(parallel_for(2, work), std::runtime_error);
  EXPECT_TRUE(done == -1 || done == inner) << done;  // a single thread never begins the second task
}

TEST(ThreadLimit, LimitsTheNumberOfWorkingThreads) {
  const int all = working_threads();
  {
    const ThreadLimit one(1);
    EXPECT_EQ(working_threads(), 1);
  }
  EXPECT_EQ(working_threads(), all);
}

TEST(ParallelFor, InnerErrorsReachTheCaller) {
  EXPECT_THROW(parallel_for(2,
                            [](std::int64_t) {
                              parallel_for(2, [](std::int64_t) { throw std::out_of_range("x"); });
                            }),
               std::out_of_range);
}

struct Listener {
  std::vector<double> seen;
  Progress progress = [this](double fraction, std::string_view step) {
    EXPECT_EQ(step, "x");
    seen.push_back(fraction);
    return true;
  };
};

TEST(Progress, PartsOfPartsCoverTheWhole) {
  Listener whole;
  const ProgressParts halves(whole.progress, 2);
  report(halves[1], 0.0, "x");
  report(ProgressParts(halves[1], 2)[1], 0.5, "x");
  report(halves[1], 1.0, "x");
  EXPECT_EQ(whole.seen, (std::vector<double>{0.5, 0.875, 1.0}));
}

TEST(Progress, PartsAreProportionalToTheirWeights) {
  Listener whole;
  const ProgressParts parts(whole.progress, {3.0, 0.0, 1.0});
  for (std::size_t i = 0; i < 3; ++i)
    for (const double fraction : {0.0, 1.0}) report(parts[i], fraction, "x");
  EXPECT_EQ(whole.seen, (std::vector<double>{0.0, 0.75, 0.75, 0.75, 0.75, 1.0}));
}

TEST(Progress, OfManyUnevenPartsIsMonotonicAndEndsAtOne) {
  Listener whole;
  std::vector<double> weights;
  for (int i = 0; i < 97; ++i) weights.push_back(0.1 + i * i % 7);
  const ProgressParts parts(whole.progress, weights);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const ProgressParts thirds(parts[i], 3);
    for (std::size_t third = 0; third < 3; ++third)
      for (const double fraction : {0.0, 0.3, 1.0}) report(thirds[third], fraction, "x");
  }
  EXPECT_TRUE(std::ranges::is_sorted(whole.seen));
  EXPECT_EQ(whole.seen.front(), 0.0);
  EXPECT_EQ(whole.seen.back(), 1.0);
}

TEST(Progress, StopsWorkOnRequest) {
  const Progress stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(report(stop, 0.0, "x"), Interrupted);
  EXPECT_THROW(report(ProgressParts(stop, 2)[0], 0.0, "x"), Interrupted);
  EXPECT_THROW(SharedProgress(stop, 1.0, "x"), Interrupted);
}

TEST(Progress, IsCalledByTheCallingThreadAndStopsAllThreads) {
  const std::thread::id caller = std::this_thread::get_id();
  double last = 0.0;
  const Progress stop_early = [&](double fraction, std::string_view step) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(step, "x");
    EXPECT_GE(fraction, last);
    last = fraction;
    return fraction == 0.0;
  };
  constexpr int items = 4, pieces = 100'000;
  SharedProgress shared(stop_early, items * pieces, "x");
  std::atomic<int> done = 0;
  EXPECT_THROW(parallel_for(items,
                            [&](std::int64_t) {
                              for (int i = 0; i < pieces; ++i) {
                                std::this_thread::sleep_for(std::chrono::microseconds(20));
                                ++done;
                                shared.add();
                              }
                            }),
               Interrupted);
  EXPECT_GT(last, 0.0);
  EXPECT_LT(done, items * pieces);
}

TEST(Progress, IsOptional) {
  SharedProgress({}, 1.0, "x").add();
  EXPECT_NO_THROW(report({}, 0.0, "x"));
  EXPECT_FALSE(ProgressParts({}, 2)[0]);
}

RemainingTime watched(const std::function<double(double)>& fraction_at, double end_s) {
  RemainingTime time;
  for (int i = 0; i <= 10 * end_s; ++i) time.add(0.1 * i, fraction_at(0.1 * i));
  return time;
}

TEST(RemainingTime, OfSteadyWorkIsExact) {
  const auto steady = [](double s) { return s / 50.0; };
  for (const double s : {3.0, 10.0, 25.0, 49.0})
    EXPECT_NEAR(watched(steady, s).seconds().value(), 50.0 - s, 0.5) << s;
}

TEST(RemainingTime, IsUnknownAtTheBeginning) {
  EXPECT_FALSE(RemainingTime().seconds());
  EXPECT_FALSE(watched([](double s) { return s / 10.0; }, 2.0).seconds());
  EXPECT_FALSE(watched([](double s) { return s / 3600.0; }, 20.0).seconds());
  EXPECT_NEAR(watched([](double s) { return s / 3600.0; }, 60.0).seconds().value(), 3540.0, 5.0);
}

TEST(RemainingTime, IsUnknownWhileTheSpeedChanges) {
  // The first 10 % take one second, the rest a hundred.
  const auto fast_first = [](double s) {
    return s < 1.0 ? 0.1 * s : 0.1 + 0.9 * (s - 1.0) / 100.0;
  };
  EXPECT_FALSE(watched(fast_first, 4.0).seconds());
  EXPECT_NEAR(watched(fast_first, 40.0).seconds().value(), 61.0, 1.0);
}

TEST(RemainingTime, OfStalledWorkIsUnknown) {
  EXPECT_FALSE(watched([](double) { return 0.0; }, 100.0).seconds());
  EXPECT_FALSE(watched([](double s) { return s < 10.0 ? 0.05 * s : 0.5; }, 60.0).seconds());
}

TEST(RemainingTime, DecreasesSmoothlyIfStepsDifferSlightly) {
  // Steps take 0.8 s and 1.2 s in turn.
  const auto uneven = [](double s) {
    const double in_pair = s - 2.0 * static_cast<int>(s / 2.0);
    const double steps = in_pair < 0.8 ? in_pair / 0.8 : 1.0 + (in_pair - 0.8) / 1.2;
    return (2.0 * static_cast<int>(s / 2.0) + steps) / 100.0;
  };
  for (double s = 10.0; s < 90.0; s += 0.7)
    EXPECT_NEAR(watched(uneven, s).seconds().value(), 100.0 - s, 0.1 * (100.0 - s) + 0.5) << s;
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/shared_progress.hpp"

namespace tofsmith {
namespace {

TEST(Progress, PartsOfPartsCoverTheWhole) {
  std::vector<double> seen;
  const Progress whole = [&](double fraction, std::string_view step) {
    EXPECT_EQ(step, "x");
    seen.push_back(fraction);
    return true;
  };
  const Progress second_half = part_of(whole, 0.5, 1.0);
  report(second_half, 0.0, "x");
  report(part_of(second_half, 0.5, 1.0), 0.5, "x");
  report(second_half, 1.0, "x");
  EXPECT_EQ(seen, (std::vector<double>{0.5, 0.875, 1.0}));
}

TEST(Progress, StopsWorkWhenItSaysSo) {
  const Progress stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(report(stop, 0.0, "x"), Interrupted);
  EXPECT_THROW(report(part_of(stop, 0.0, 0.5), 0.0, "x"), Interrupted);
}

TEST(Progress, IsCalledByTheThreadThatAsksAndStopsEveryThreadBetweenPieces) {
  const std::thread::id caller = std::this_thread::get_id();
  double last = 0.0;
  const Progress stop_early = [&](double fraction, std::string_view step) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(step, "x");
    EXPECT_GE(fraction, last);
    last = fraction;
    return fraction < 0.01;
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

TEST(Progress, NoneIsAskedForNothing) {
  SharedProgress({}, 1.0, "x").add();
  EXPECT_NO_THROW(report({}, 0.0, "x"));
  EXPECT_FALSE(part_of({}, 0.0, 1.0));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "core/shared/working_threads.hpp"

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/parallel.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/shared/working_threads.hpp"
#include "tofsmith/core/error.hpp"

// Debian's TBB is not instrumented, so the thread sanitizer would report false races.
#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#elif defined(TOFSMITH_HAS_TBB)
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <optional>
#endif

namespace tofsmith {

#if defined(__SANITIZE_THREAD__)
namespace {

std::atomic<int> allowed_threads = 4;
thread_local bool is_at_work = false;  // nested loops run on the calling thread

class Team {
 public:
  Team(std::int64_t count, const std::function<void(std::int64_t)>& work)
      : count_(count), work_(work) {}
  void run() {
    std::vector<std::thread> others;
    const auto threads = std::min<std::int64_t>(is_at_work ? 1 : allowed_threads.load(), count_);
    for (std::int64_t i = 1; i < threads; ++i) others.emplace_back([this] { take_part(); });
    take_part();
    for (std::thread& other : others) other.join();
    if (problem_) std::rethrow_exception(problem_);
  }

 private:
  void take_part() {
    const bool was_at_work = std::exchange(is_at_work, true);
    try {
      for (std::int64_t i; (i = next_++) < count_;) work_(i);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      problem_ = std::current_exception();
      next_ = count_;
    }
    is_at_work = was_at_work;
  }

  std::int64_t count_;
  const std::function<void(std::int64_t)>& work_;
  std::atomic<std::int64_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr problem_;
};

}  // namespace

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  Team(count, work).run();
}

struct ThreadLimit::Control {
  explicit Control(int threads) : around(allowed_threads.exchange(threads)) {}
  ~Control() { allowed_threads = around; }
  int around;  ///< limit to restore
};

int working_threads() { return allowed_threads; }
#elif defined(TOFSMITH_HAS_TBB)
namespace {

/// Arena for more threads than cores; null: TBB's default.
std::atomic<tbb::task_arena*> wide_arena = nullptr;

int allowed_parallelism() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace

int working_threads() {
  return wide_arena.load() != nullptr
             ? allowed_parallelism()
             : std::min(allowed_parallelism(), tbb::info::default_concurrency());
}

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  const auto run = [&] {
    // If an enclosing task group is cancelled, TBB skips iterations but returns normally.
    tbb::task_group_context own;
    tbb::parallel_for(
        std::int64_t{0}, count, [&](std::int64_t i) { work(i); }, own);
    if (own.is_group_execution_cancelled()) throw Interrupted();
  };
  if (tbb::task_arena* const arena = wide_arena.load())
    arena->execute(run);
  else
    run();
}

struct ThreadLimit::Control {
  explicit Control(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {
    const int allowed = allowed_parallelism();
    if (allowed > tbb::info::default_concurrency()) arena.emplace(allowed);
    around = wide_arena.exchange(arena ? &*arena : nullptr);
  }
  ~Control() { wide_arena = around; }

  tbb::global_control control;
  std::optional<tbb::task_arena> arena;
  tbb::task_arena* around = nullptr;  ///< limit to restore
};
#else  // serial, on the calling thread
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  for (std::int64_t i = 0; i < count; ++i) work(i);
}

struct ThreadLimit::Control {
  explicit Control(int) {}
};

int working_threads() { return 1; }
#endif

void parallel_for_blocks(std::int64_t count, std::int64_t block,
                         const std::function<void(IndexRange)>& work) {
  TOFSMITH_ASSERT_LT(std::int64_t{0}, block);
  const std::int64_t blocks = (count + block - 1) / block;
  const auto work_on = [&](std::int64_t b) { work({b * block, std::min(count, (b + 1) * block)}); };
  parallel_for(blocks, std::ref(work_on));  // without a heap allocation
}

ThreadLimit::ThreadLimit(int threads) {
  require(threads >= 0, "threads", threads, "must be >= 0 (0 uses every core)");
  if (threads > 0) control_ = make_hidden<Control>(threads);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/parallel.hpp"

#include <algorithm>
#include <functional>

#include "tofsmith/core/error.hpp"

#ifdef TOFSMITH_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <optional>
#endif

namespace tofsmith {

#ifdef TOFSMITH_HAS_TBB
namespace {

/// Where work is done that more threads were asked for than there are cores; null: TBB's own
/// choice, which is never more.
std::atomic<tbb::task_arena*> wide_arena = nullptr;

}  // namespace

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  const auto run = [&] {
    tbb::parallel_for(std::int64_t{0}, count, [&](std::int64_t i) { work(i); });
  };
  if (tbb::task_arena* const arena = wide_arena.load())
    arena->execute(run);
  else
    run();
}

struct ThreadLimit::Control {
  explicit Control(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {
    if (threads > tbb::info::default_concurrency()) arena.emplace(threads);
    around = wide_arena.exchange(arena ? &*arena : nullptr);
  }
  ~Control() { wide_arena = around; }

  tbb::global_control control;
  std::optional<tbb::task_arena> arena;
  tbb::task_arena* around = nullptr;  ///< of the limit outside of this one
};
#else  // in the thread that asks, in order
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  for (std::int64_t i = 0; i < count; ++i) work(i);
}

struct ThreadLimit::Control {
  explicit Control(int) {}
};
#endif

void parallel_for_blocks(std::int64_t count, std::int64_t block,
                         const std::function<void(IndexRange)>& work) {
  TOFSMITH_ASSERT_LT(std::int64_t{0}, block);
  const std::int64_t blocks = (count + block - 1) / block;
  const auto work_on = [&](std::int64_t b) { work({b * block, std::min(count, (b + 1) * block)}); };
  parallel_for(blocks, std::ref(work_on));  // a function object of this size would be allocated
}

ThreadLimit::ThreadLimit(int threads) {
  require(threads >= 0, "threads", threads, "must be >= 0 (0 uses every core)");
  if (threads > 0) control_ = std::make_unique<Control>(threads);
}
ThreadLimit::~ThreadLimit() = default;

}  // namespace tofsmith

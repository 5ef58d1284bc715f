// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/parallel.hpp"

#include <algorithm>
#include <functional>

#include "tofsmith/core/error.hpp"

#ifdef TOFSMITH_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#endif

namespace tofsmith {

#ifdef TOFSMITH_HAS_TBB
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  // Where another part of the work that this belongs to fails, TBB leaves out what is not begun
  // here and returns as if all were done.
  tbb::task_group_context own;
  tbb::parallel_for(
      std::int64_t{0}, count, [&](std::int64_t i) { work(i); }, own);
  if (own.is_group_execution_cancelled()) throw Interrupted();
}

struct ThreadLimit::Control {
  explicit Control(std::size_t threads)
      : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};
#else  // in the thread that asks, in order
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work) {
  for (std::int64_t i = 0; i < count; ++i) work(i);
}

struct ThreadLimit::Control {
  explicit Control(std::size_t) {}
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
  if (threads > 0) control_ = std::make_unique<Control>(static_cast<std::size_t>(threads));
}
ThreadLimit::~ThreadLimit() = default;

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "tofsmith/core/hidden.hpp"

namespace tofsmith {

struct IndexRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// Calls `work` for blocks of at most `block` indices that cover [0, count), on all threads. Blocks
/// do not depend on the number of threads, so sums over blocks in order have the same bits on any
/// machine.
void parallel_for_blocks(std::int64_t count, std::int64_t block,
                         const std::function<void(IndexRange)>& work);

/// Calls `work(i)` for every i in [0, count), on all threads, or on one without TBB.
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& work);

/// As parallel_for(), for indices of containers.
inline void parallel_for_indices(std::size_t count, const std::function<void(std::size_t)>& work) {
  parallel_for(static_cast<std::int64_t>(count),
               [&](std::int64_t i) { work(static_cast<std::size_t>(i)); });
}

/// Limits the number of threads during its lifetime; 0: all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ThreadLimit(ThreadLimit&&) = delete;  // limits end in reverse order

 private:
  struct Control;
  Hidden<Control> control_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith::python {

/// A ThreadLimit shared by calls in several threads: it exists while any of them runs, with the
/// number of threads of the first call.
class SharedThreadLimit {
 public:
  explicit SharedThreadLimit(int threads) {
    const std::lock_guard lock(mutex_);
    if (calls_++ == 0 && threads > 0) limit_.emplace(threads);
  }
  ~SharedThreadLimit() {
    const std::lock_guard lock(mutex_);
    if (--calls_ == 0) limit_.reset();
  }
  SharedThreadLimit(const SharedThreadLimit&) = delete;
  SharedThreadLimit& operator=(const SharedThreadLimit&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int calls_ = 0;
  static inline std::optional<ThreadLimit> limit_;
};

}  // namespace tofsmith::python

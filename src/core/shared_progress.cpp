// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/shared_progress.hpp"

#include <algorithm>
#include <utility>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

SharedProgress::SharedProgress(Progress progress, double pieces, std::string step)
    : progress_(std::move(progress)), pieces_(pieces), step_(std::move(step)) {
  report(progress_, 0.0, step_);
}

void SharedProgress::add(double pieces) {
  if (!progress_) return;
  double done = done_.load(std::memory_order_relaxed);  // libc++ 14 lacks fetch_add for doubles
  while (!done_.compare_exchange_weak(done, done + pieces, std::memory_order_relaxed)) {
  }
  done += pieces;
  if (is_stopped_.load(std::memory_order_relaxed)) throw Interrupted();
  if (std::this_thread::get_id() != caller_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - reported_at_ < std::chrono::milliseconds(50)) return;
  reported_at_ = now;
  if (progress_(std::min(1.0, done / pieces_), step_)) return;
  is_stopped_.store(true, std::memory_order_relaxed);
  throw Interrupted();
}

}  // namespace tofsmith

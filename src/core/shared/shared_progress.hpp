// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Progress of a parallel loop, which can be cancelled between its pieces. The callback is called
/// only from the thread that created this object, at a limited rate.
class SharedProgress {
 public:
  /// @param pieces  total number
  /// @throws Interrupted if the callback cancels
  SharedProgress(Progress progress, double pieces, std::string step);

  /// Adds completed pieces, possibly fractions. @throws Interrupted on every thread after
  /// cancellation
  void add(double pieces = 1.0);

 private:
  const Progress progress_;
  const double pieces_;
  const std::string step_;
  const std::thread::id caller_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point reported_at_ = std::chrono::steady_clock::now();
  std::atomic<double> done_ = 0.0;
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace tofsmith

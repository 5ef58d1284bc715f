// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Progress inside a parallel loop, so that it can be stopped between its pieces. Any thread tells
/// what it has done; the callback is only called from the thread that made this object, and not
/// more often than people can read, so that small pieces cost nothing.
class SharedProgress {
 public:
  /// Tells that `step` begins.
  /// @param pieces  how many make the whole
  /// @throws Interrupted if the callback asks to stop
  SharedProgress(Progress progress, double pieces, std::string step);

  /// `pieces` more are done; parts of one count too.
  /// @throws Interrupted on every thread once the callback has asked to stop
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

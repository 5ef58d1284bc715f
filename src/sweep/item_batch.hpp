// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Computes items on all threads in the background. The destructor stops the work.
class ItemBatch {
 public:
  ItemBatch(const WorkList& list, std::vector<ClaimedItem> items);
  ~ItemBatch();
  ItemBatch(const ItemBatch&) = delete;
  ItemBatch& operator=(const ItemBatch&) = delete;

  /// Returns new outcomes after at most `max_wait`.
  std::vector<ItemOutcome> wait(std::chrono::milliseconds max_wait);
  /// True when the work has ended; wait() may still return outcomes.
  bool is_done() const { return done_; }
  /// Returns the outcomes that wait() has not returned.
  std::vector<ItemOutcome> stop();
  /// Progress in [0, 1] of a batch of one item; 0 for larger batches.
  double fraction() const { return fraction_; }

 private:
  void compute_all();
  void compute(const ClaimedItem& item);

  const WorkList& list_;
  std::vector<ClaimedItem> items_;
  std::atomic<bool> stop_ = false, done_ = false;
  std::atomic<double> fraction_ = 0.0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<ItemOutcome> outcomes_;
  std::thread thread_;  // last, because it uses all members
};

}  // namespace tofsmith

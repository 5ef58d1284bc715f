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

/// Computes items on all threads in the background, so that the thread that made it can store
/// outcomes as they come. The destructor stops the work.
class ItemBatch {
 public:
  ItemBatch(const WorkList& list, std::vector<ClaimedItem> items);
  ~ItemBatch();
  ItemBatch(const ItemBatch&) = delete;
  ItemBatch& operator=(const ItemBatch&) = delete;

  /// Waits up to `max_wait` for outcomes. @return the new ones
  std::vector<ItemOutcome> wait(std::chrono::milliseconds max_wait);
  /// True after the end of the work. wait() may still return outcomes.
  bool is_done() const { return done_; }
  /// Ends the work. @return the outcomes that wait() did not return
  std::vector<ItemOutcome> stop();
  /// How much of a batch of one item is done, in [0, 1]; 0 of larger ones.
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
  std::thread thread_;  // last: it uses all others
};

}  // namespace tofsmith

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

/// An item that was claimed.
struct ClaimedItem {
  std::int64_t item;
  std::string key;
};

/// Computes items on all threads while the thread that made it goes on: that one stores what comes
/// out. The destructor stops the work.
class ItemBatch {
 public:
  ItemBatch(const WorkList& list, std::vector<ClaimedItem> items);
  ~ItemBatch();
  ItemBatch(const ItemBatch&) = delete;
  ItemBatch& operator=(const ItemBatch&) = delete;

  /// Waits at most so long for something to come out, and takes what did.
  std::vector<ItemOutcome> wait(std::chrono::milliseconds max_wait);
  /// Waits for the end, and takes nothing.
  void wait_until_done();
  /// Whether all is computed. What came out last may still be waiting.
  bool is_done() const { return done_; }
  /// Asks all work to stop; wait() gives what was finished nevertheless.
  void stop() { stop_ = true; }
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

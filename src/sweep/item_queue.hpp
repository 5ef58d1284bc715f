// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "sweep/item_batch.hpp"

namespace tofsmith {

/// Items that one process has to compute, batch after batch.
class ItemQueue {
 public:
  explicit ItemQueue(const WorkList& list) : list_(list) {}

  /// Items that come when the batch in work is done.
  void give(std::vector<ClaimedItem> items);
  /// Waits at most so long for something to come out, and takes what did.
  std::vector<ItemOutcome> wait(std::chrono::milliseconds max_wait);
  /// Drops what is unfinished. @return what was finished nevertheless
  std::vector<ItemOutcome> stop();
  /// Whether nothing is left to compute or to take.
  bool is_empty() const { return !batch_ && waiting_.empty(); }
  /// How much of a batch of one item is done, in [0, 1]; 0 of larger ones.
  double fraction() const { return batch_ ? batch_->fraction() : 0.0; }

 private:
  void start_next();

  const WorkList& list_;
  std::optional<ItemBatch> batch_;
  std::vector<ClaimedItem> waiting_;
};

}  // namespace tofsmith

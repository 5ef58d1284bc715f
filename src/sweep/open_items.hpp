// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sweep/item_batch.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// The items of a run that are not known to be finished: first those that were never asked for,
/// then those that others had when we asked.
class OpenItems {
 public:
  /// @param keys  of all items of the list; must outlive this
  OpenItems(std::span<const std::string> keys, const SweepShard& shard);

  /// Adds all of them to a store that lacks them.
  void add_to(SweepStore& store, const WorkList& list, const Progress& progress);
  /// Claims up to `most`. May come back empty-handed though some are open.
  std::vector<ClaimedItem> claim(SweepStore& store, std::size_t most);

  std::size_t count() const { return count_; }
  /// Items that nobody needs to compute any more, or that are ours.
  std::size_t settled() const { return settled_; }
  bool are_none() const { return settled_ == count_; }
  bool were_all_asked() const { return next_ == items_.size(); }

 private:
  std::vector<std::string> keys_of(std::span<const std::int64_t> items) const;

  std::span<const std::string> keys_;
  std::vector<std::int64_t> items_, taken_;
  std::size_t next_ = 0, settled_ = 0, count_ = 0;
};

}  // namespace tofsmith

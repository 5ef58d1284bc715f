// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/sweep/sweep_ranks.hpp"
#include "tofsmith/sweep/sweep_store.hpp"
#include "tofsmith/sweep/work_list.hpp"

namespace tofsmith {

/// One part of a sweep that is cut in parts for machines that share nothing.
struct SweepShard {
  int index = 1;  ///< 1 .. count
  int count = 1;

  /// Whether an item belongs to this part. That depends on its key alone, so it stays where it is
  /// when axes grow.
  bool holds(std::string_view key) const;
  /// The rule that it breaks; none: it is a part of count.
  std::optional<BrokenRule> broken_rule() const;
  /// @throws InvalidArgument of broken_rule(), if there is one
  void validate() const;
};

struct SweepRunOptions {
  SweepShard shard;
  double lease_s = SweepStoreOptions{}.lease_s;  ///< of the store, whose worker must show life
  double batch_s = 1.0;  ///< work that is taken at a time, so lost when killed [s], > 0
  /// Of a job of more ranks than that, rank 0 hands out and stores only; it computes too in smaller
  /// ones. >= 1
  int most_ranks_computing = 64;

  void validate() const;
};

/// What a run did.
struct SweepRun {
  std::int64_t computed = 0;          ///< items that this run finished
  std::vector<std::string> failures;  ///< one line for each item that this run could not finish
};

/// Finishes all items of a sweep that are unfinished, together with all other processes that work
/// on the store; waits for items that others have at the end. Results have the same bits whatever
/// the number of threads and processes.
/// @param keys      of all items, WorkList::keys()
/// @param progress  called about 20 times a second. When it asks to stop, what is finished is kept
/// @param ranks     of which this is rank 0, and which compute too; null if there are no others
/// @throws IoError if the store fails; Interrupted if progress says so, here or on another rank;
///         std::runtime_error if another rank cannot go on
SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options = {}, const Progress& progress = {},
                   SweepRanks* ranks = nullptr);

}  // namespace tofsmith

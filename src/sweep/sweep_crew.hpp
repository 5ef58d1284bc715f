// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "sweep/item_queue.hpp"
#include "tofsmith/sweep/sweep_ranks.hpp"

namespace tofsmith {

/// All who compute for a run: this process and, of a job of several ranks, the others.
class SweepCrew {
 public:
  /// What became of items that a member was given.
  struct Delivery {
    std::size_t member;
    std::vector<ItemOutcome> outcomes;
  };

  /// @param ranks          this must be rank 0 of them; null if there are no others
  /// @param computes_here  whether this process is one of the members
  SweepCrew(const WorkList& list, SweepRanks* ranks, bool computes_here);

  std::size_t size() const { return (computes_here_ ? 1 : 0) + others_; }
  void give(std::size_t member, std::vector<ClaimedItem> items);
  /// Waits a moment for something to come out.
  /// @throws Interrupted if a member's user asks to stop; std::runtime_error if one cannot go on
  std::vector<Delivery> wait();
  /// Sends all home, and drops what is unfinished. @return what was finished nevertheless
  std::vector<ItemOutcome> stop();
  /// How far this process is with a single item, in [0, 1].
  double fraction() const { return own_.fraction(); }

 private:
  SweepRanks* ranks_;
  bool computes_here_;
  std::size_t others_;
  ItemQueue own_;
};

}  // namespace tofsmith

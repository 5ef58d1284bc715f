// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "design/basin_hops.hpp"
#include "tofsmith/core/shared_progress.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// Codes that descents from many starts lead to, best first, with what happened on the way.
class OptimizePool {
 public:
  OptimizePool(const DesignProblem& problem, const OptimizeOptions& options, double bin_m);

  /// Descends from all starts.
  void run_starts(std::span<const CodeSet> also, const Progress& progress);
  /// Descends from changed copies of the best, until hops or patience end.
  void run_hops(const Progress& progress);
  /// Descends once more, from softened copies of the best; keeps the better of each.
  void refine(const Progress& progress);

  const std::vector<PoolEntry>& entries() const { return entries_; }
  /// The least error so far after every descent.
  const std::vector<SearchStep>& history() const { return history_; }
  std::int64_t steps() const { return steps_; }
  bool ended_early() const { return ended_early_; }
  const CodeJudge& judge() const { return judge_; }
  /// Adds a descent to the history.
  void record(double log_error_bin);

 private:
  void descend_all(std::vector<PoolEntry>& entries, int steps, double rate, std::uint64_t phase,
                   std::size_t first_item, SharedProgress& progress) const;
  void keep(std::vector<PoolEntry> entries);

  const DesignProblem* problem_;
  OptimizeOptions options_;
  double bin_m_;
  CodeJudge judge_;
  std::vector<PoolEntry> entries_;
  std::vector<SearchStep> history_;
  std::int64_t steps_ = 0;
  bool ended_early_ = false;
};

}  // namespace tofsmith

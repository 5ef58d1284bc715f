// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "sweep/item_batch.hpp"
#include "sweep/key_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds max_wait(50);

/// Number of items for `batch_s` of work at the previous speed, and fewer near the end, so that
/// processes that share a store finish together.
class BatchSize {
 public:
  explicit BatchSize(double batch_s) : batch_s_(batch_s) {}

  std::size_t next(std::size_t left) const {
    const double items = std::clamp(batch_s_ / std::max(each_s_, 1e-6), 1.0, 256.0);
    return std::clamp<std::size_t>(left / 2, 1, static_cast<std::size_t>(items));
  }
  void measure(std::size_t items, Clock::duration time) {
    each_s_ = std::chrono::duration<double>(time).count() / static_cast<double>(items);
  }

 private:
  double batch_s_;
  double each_s_ = 1e6;  // unknown: the first batch has one item
};

void keep(const std::vector<ItemOutcome>& outcomes, SweepQueue& queue, SweepRun& run) {
  queue.finish(outcomes);
  for (const ItemOutcome& outcome : outcomes) {
    if (outcome.message.empty())
      ++run.computed;
    else
      run.failures.push_back(outcome.message);
  }
}

}  // namespace

bool SweepShard::holds(std::string_view key) const {
  return key_number(key) % static_cast<std::uint64_t>(count) ==
         static_cast<std::uint64_t>(index - 1);
}

std::optional<BrokenRule> SweepShard::broken_rule() const {
  if (count < 1) return broken("shard.count", count, "must be >= 1");
  if (index < 1 || index > count) return broken("shard.index", index, "must be in [1, count]");
  return std::nullopt;
}

void SweepShard::validate() const { require(broken_rule()); }

void SweepRunOptions::validate() const {
  shard.validate();
  require(batch_s > 0.0, "batch_s", batch_s, "must be > 0");
}

SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options, const Progress& progress) {
  options.validate();
  SweepQueue queue(list, keys, store, options.shard, progress);
  BatchSize size(options.batch_s);
  SweepRun run;
  for (;;) {
    std::vector<ClaimedItem> items = queue.claim(size.next(queue.left()));
    if (items.empty()) return run;
    const std::size_t count = items.size();
    const Clock::time_point begin = Clock::now();
    ItemBatch batch(list, std::move(items));
    try {
      for (bool is_done = false; !is_done;) {
        is_done = batch.is_done();  // before wait(), which then returns the last outcomes
        keep(batch.wait(max_wait), queue, run);
        report(progress,
               (static_cast<double>(queue.settled()) + batch.fraction()) /
                   static_cast<double>(queue.size()),
               fmt::format("{} of {} items", queue.settled(), queue.size()));
      }
    } catch (const Interrupted&) {
      keep(batch.stop(), queue, run);
      throw;
    }
    size.measure(count, Clock::now() - begin);
  }
}

}  // namespace tofsmith

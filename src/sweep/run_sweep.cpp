// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <unordered_set>

#include "sweep/item_batch.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The items of a run that are not known to be finished: first those that were never asked for,
/// then those that others had when we asked.
class OpenItems {
 public:
  OpenItems(std::span<const std::string> keys, const SweepShard& shard) {
    std::unordered_set<std::string_view> seen;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!shard.holds(keys[i]) || !seen.insert(keys[i]).second) continue;
      keys_.push_back(keys[i]);
      items_.push_back(static_cast<std::int64_t>(i));
    }
    count_ = keys_.size();
  }

  const std::vector<std::string>& keys() const { return keys_; }
  const std::vector<std::int64_t>& items() const { return items_; }
  std::size_t count() const { return count_; }
  /// Items that nobody needs to compute any more, or that are ours.
  std::size_t settled() const { return settled_; }
  bool are_none() const { return settled_ == count_; }
  bool were_all_asked() const { return next_ == keys_.size(); }

  /// Claims up to `most`. May come back empty-handed though some are open.
  std::vector<ClaimedItem> claim(SweepStore& store, std::size_t most) {
    if (were_all_asked()) start_over();
    const std::span<const std::string> rest = std::span(keys_).subspan(next_);
    std::vector<ClaimedItem> ours;
    for (const ClaimAnswer answer : store.claim(rest, most)) {
      if (answer == ClaimAnswer::taken)
        taken_.push_back(next_);
      else
        ++settled_;
      if (answer == ClaimAnswer::ours) ours.push_back({items_[next_], keys_[next_]});
      ++next_;
    }
    return ours;
  }

 private:
  /// Goes on with those that others had.
  void start_over() {
    std::vector<std::string> keys;
    std::vector<std::int64_t> items;
    for (const std::size_t i : taken_) {
      keys.push_back(std::move(keys_[i]));
      items.push_back(items_[i]);
    }
    keys_ = std::move(keys);
    items_ = std::move(items);
    taken_.clear();
    next_ = 0;
  }

  std::vector<std::string> keys_;
  std::vector<std::int64_t> items_;
  std::vector<std::size_t> taken_;
  std::size_t next_ = 0, settled_ = 0, count_ = 0;
};

/// One run: claims, computes, stores, over and over.
class Runner {
 public:
  Runner(const WorkList& list, SweepStore& store, const SweepRunOptions& options,
         const Progress& progress, OpenItems& open)
      : list_(list), store_(store), options_(options), progress_(progress), open_(open) {}

  SweepRun run() {
    while (!open_.are_none()) {
      std::vector<ClaimedItem> items = open_.claim(store_, batch_items_);
      if (!items.empty())
        compute(std::move(items));
      else if (open_.were_all_asked() && !open_.are_none())
        wait_for_others();
      show_life(0.0);
    }
    return std::move(result_);
  }

 private:
  void compute(std::vector<ClaimedItem> items) {
    const std::size_t count = items.size();
    const Clock::time_point begin = Clock::now();
    in_work_ = count;
    ItemBatch batch(list_, std::move(items));
    try {
      while (!batch.is_done()) {
        keep(batch.wait());
        show_life(batch.fraction());
      }
    } catch (const Interrupted&) {
      batch.stop();
      while (!batch.is_done()) keep(batch.wait());
      keep(batch.wait());
      throw;
    }
    keep(batch.wait());
    const double each_s = seconds_since(begin) / static_cast<double>(count);
    batch_items_ =
        static_cast<std::size_t>(std::clamp(options_.batch_s / std::max(each_s, 1e-6), 1.0, 256.0));
  }

  void keep(const std::vector<ItemOutcome>& outcomes) {
    store_.finish(outcomes);
    for (const ItemOutcome& outcome : outcomes) {
      --in_work_;
      if (outcome.message.empty())
        ++result_.computed;
      else
        result_.failures.push_back(outcome.message);
    }
  }

  void wait_for_others() {
    const Clock::time_point begin = Clock::now();
    while (seconds_since(begin) < 0.3) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      show_life(0.0);
    }
  }

  /// To the user, and to other workers.
  void show_life(double fraction_of_one) {
    if (seconds_since(last_beat_) > options_.lease_s / 6) {
      store_.beat();
      last_beat_ = Clock::now();
    }
    const std::size_t finished = open_.settled() - in_work_;
    report(progress_,
           (static_cast<double>(finished) + fraction_of_one) / static_cast<double>(open_.count()),
           fmt::format("{} of {} items", finished, open_.count()));
  }

  const WorkList& list_;
  SweepStore& store_;
  const SweepRunOptions& options_;
  const Progress& progress_;
  OpenItems& open_;
  SweepRun result_;
  std::size_t batch_items_ = 1;
  std::size_t in_work_ = 0;
  Clock::time_point last_beat_ = Clock::now();
};

}  // namespace

bool SweepShard::holds(std::string_view key) const {
  std::uint64_t number = 0;
  std::from_chars(key.data(), key.data() + std::min<std::size_t>(key.size(), 16), number, 16);
  return number % static_cast<std::uint64_t>(count) == static_cast<std::uint64_t>(index - 1);
}

void SweepShard::validate() const {
  require(count >= 1, "shard.count", count, "must be >= 1");
  require(index >= 1 && index <= count, "shard.index", index, "must be in 1 .. count");
}

void SweepRunOptions::validate() const {
  shard.validate();
  require(lease_s > 0.0, "lease_s", lease_s, "must be > 0");
  require(batch_s > 0.0, "batch_s", batch_s, "must be > 0");
}

SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options, const Progress& progress) {
  options.validate();
  OpenItems open(keys, options.shard);
  store.add(open.keys(), [&](std::size_t i) { return list.settings_json(open.items()[i]); });
  return Runner(list, store, options, progress, open).run();
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sweep/item_batch.hpp"
#include "sweep/item_queue.hpp"
#include "sweep/key_order.hpp"
#include "sweep/rank_state.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// The items of a run that are not known to be finished: first those that were never asked for,
/// then those that others had when we asked.
class OpenItems {
 public:
  /// @param keys  of all items of the list; must outlive this
  OpenItems(std::span<const std::string> keys, const SweepShard& shard);

  /// Adds all of them to a store that lacks them.
  void add_to(SweepStore& store, const WorkList& list, const Progress& progress);
  /// Claims up to `most`. May come back empty-handed though some are open.
  std::vector<ClaimedItem> claim(SweepStore& store, std::size_t max_items);

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

/// Most items that a store is asked about, or given, at a time.
constexpr std::size_t max_asked_at_once = 4096;

OpenItems::OpenItems(std::span<const std::string> keys, const SweepShard& shard)
    : keys_(keys), items_(key_order(keys)) {
  std::erase_if(items_,
                [&](std::int64_t i) { return !shard.holds(keys[static_cast<std::size_t>(i)]); });
  count_ = items_.size();
}

void OpenItems::add_to(SweepStore& store, const WorkList& list, const Progress& progress) {
  // In the order of the keys, which is the store's own: then it grows at its end.
  const std::span<const std::int64_t> items(items_);
  for (std::size_t begin = 0; begin < items.size(); begin += max_asked_at_once) {
    report(progress, 0.0, fmt::format("adding items: {} of {}", begin, items.size()));
    const auto part = items.subspan(begin, std::min(max_asked_at_once, items.size() - begin));
    store.add(keys_of(part), [&](std::size_t i) { return list.settings_json(part[i]); });
  }
  std::ranges::sort(items_);
}

std::vector<ClaimedItem> OpenItems::claim(SweepStore& store, std::size_t max_items) {
  if (were_all_asked()) {  // go on with those that others had
    items_ = std::exchange(taken_, {});
    next_ = 0;
  }
  const std::size_t some = std::min(max_asked_at_once, items_.size() - next_);
  const std::vector<std::string> keys = keys_of(std::span(items_).subspan(next_, some));
  std::vector<ClaimedItem> ours;
  for (const ClaimAnswer answer : store.claim(keys, max_items)) {
    const std::int64_t item = items_[next_++];
    if (answer == ClaimAnswer::taken)
      taken_.push_back(item);
    else
      ++settled_;
    if (answer == ClaimAnswer::ours) ours.push_back({item, keys_[static_cast<std::size_t>(item)]});
  }
  return ours;
}

std::vector<std::string> OpenItems::keys_of(std::span<const std::int64_t> items) const {
  std::vector<std::string> keys;
  keys.reserve(items.size());
  for (const std::int64_t item : items) keys.push_back(keys_[static_cast<std::size_t>(item)]);
  return keys;
}

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

/// Long enough to leave the processor to others, short enough for the user; shorter where other
/// ranks wait for us.
constexpr std::chrono::milliseconds alone_wait(50), served_wait(1);

SweepCrew::SweepCrew(const WorkList& list, SweepRanks* ranks, bool computes_here)
    : ranks_(ranks),
      computes_here_(computes_here),
      others_(ranks == nullptr ? 0 : static_cast<std::size_t>(ranks->count() - 1)),
      own_(list) {}

void SweepCrew::give(std::size_t member, std::vector<ClaimedItem> items) {
  if (computes_here_ && member == 0) return own_.give(std::move(items));
  const int rank = static_cast<int>(member) + (computes_here_ ? 0 : 1);
  ranks_->state().send(rank, RankTag::items, bytes_of(items));
}

std::vector<SweepCrew::Delivery> SweepCrew::wait() {
  std::vector<Delivery> deliveries;
  auto own = own_.wait(others_ > 0 ? served_wait : alone_wait);
  if (!own.empty()) deliveries.push_back({0, std::move(own)});
  if (others_ == 0) return deliveries;
  SweepRanks::State& state = ranks_->state();
  while (std::optional<RankMessage> message = state.world->receive()) {
    const auto tag = static_cast<RankTag>(message->tag);
    if (tag == RankTag::interrupted) throw Interrupted();
    if (tag == RankTag::trouble)
      throw std::runtime_error(fmt::format("{}: {}", state.name_of(message->rank), message->bytes));
    if (tag == RankTag::outcomes)
      deliveries.push_back({static_cast<std::size_t>(message->rank) - (computes_here_ ? 0 : 1),
                            outcomes_of(message->bytes)});
  }
  return deliveries;
}

std::vector<ItemOutcome> SweepCrew::stop() {
  std::vector<ItemOutcome> outcomes = own_.stop();
  if (others_ == 0) return outcomes;
  std::vector<ItemOutcome> theirs = ranks_->state().send_home();
  outcomes.insert(outcomes.end(), std::make_move_iterator(theirs.begin()),
                  std::make_move_iterator(theirs.end()));
  return outcomes;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// How much one member of the crew has to do, and how fast it is.
class MemberLoad {
 public:
  /// Items for about `batch_s` of work; fewer near the end, so that all end together.
  std::size_t batch(double batch_s, std::size_t left, std::size_t members) const {
    const double max_items = std::clamp(batch_s / std::max(each_s_, 1e-6), 1.0, 256.0);
    const std::size_t share = left / (2 * members);
    return std::max<std::size_t>(1, std::min(static_cast<std::size_t>(max_items), share));
  }
  /// It is to have the next batch before it is done with this one.
  bool is_short_of(std::size_t batch) const { return in_work_ <= batch / 2; }

  void give(std::size_t items) {
    if (in_work_ == 0) restart();
    in_work_ += items;
  }
  void take(std::size_t items) {
    in_work_ -= items;
    done_ += items;
    each_s_ = seconds_since(begin_) / static_cast<double>(done_);
    if (seconds_since(begin_) > 5.0) restart();
  }

 private:
  void restart() {
    begin_ = Clock::now();
    done_ = 0;
  }

  std::size_t in_work_ = 0, done_ = 0;
  double each_s_ = 1e6;  // not known yet: it gets one
  Clock::time_point begin_;
};

/// One run: claims, has computed, stores, over and over.
class Runner {
 public:
  Runner(const WorkList& list, SweepStore& store, const SweepRunOptions& options,
         const Progress& progress, OpenItems& open, SweepRanks* ranks)
      : store_(store),
        options_(options),
        progress_(progress),
        open_(open),
        crew_(list, ranks, ranks == nullptr || ranks->count() <= options.max_ranks_computing),
        loads_(crew_.size()) {}

  SweepRun run() {
    try {
      while (!open_.are_none() || in_work() > 0) {
        claim();
        hand_out();
        take(crew_.wait());
        show_life();
      }
    } catch (const Interrupted&) {
      keep(crew_.stop());
      throw;
    }
    return std::move(result_);
  }

 private:
  std::size_t in_work() const { return computing_ + ready_.size(); }
  /// Items that are still to be given to somebody, or were not asked for.
  std::size_t left() const { return open_.count() - open_.settled() + ready_.size(); }
  std::size_t batch_of(const MemberLoad& load) const {
    return load.batch(options_.batch_s, left(), loads_.size());
  }

  /// Enough for all members who are short of work, in one transaction.
  void claim() {
    if (open_.are_none()) return;
    std::size_t wanted = 0;
    for (const MemberLoad& load : loads_)
      if (load.is_short_of(batch_of(load))) wanted += batch_of(load);
    if (wanted <= ready_.size()) return;
    if (open_.were_all_asked() && seconds_since(asked_all_at_) < 0.3) return;
    for (ClaimedItem& item : open_.claim(store_, wanted - ready_.size()))
      ready_.push_back(std::move(item));
    if (open_.were_all_asked()) asked_all_at_ = Clock::now();
  }

  void hand_out() {
    for (std::size_t m = 0; m < loads_.size() && !ready_.empty(); ++m) {
      const std::size_t batch = std::min(batch_of(loads_[m]), ready_.size());
      if (!loads_[m].is_short_of(batch_of(loads_[m]))) continue;
      const auto end = ready_.begin() + static_cast<std::ptrdiff_t>(batch);
      crew_.give(m, {std::make_move_iterator(ready_.begin()), std::make_move_iterator(end)});
      ready_.erase(ready_.begin(), end);
      loads_[m].give(batch);
      computing_ += batch;
    }
  }

  /// Stores all that came, in one transaction.
  void take(std::vector<SweepCrew::Delivery> deliveries) {
    std::vector<ItemOutcome> outcomes;
    for (SweepCrew::Delivery& delivery : deliveries) {
      loads_[delivery.member].take(delivery.outcomes.size());
      outcomes.insert(outcomes.end(), std::make_move_iterator(delivery.outcomes.begin()),
                      std::make_move_iterator(delivery.outcomes.end()));
    }
    keep(outcomes);
  }

  void keep(const std::vector<ItemOutcome>& outcomes) {
    store_.finish(outcomes);
    for (const ItemOutcome& outcome : outcomes) {
      --computing_;
      if (outcome.message.empty())
        ++result_.computed;
      else
        result_.failures.push_back(outcome.message);
    }
  }

  /// To the user, and to other workers.
  void show_life() {
    if (seconds_since(last_beat_) > options_.lease_s / 6) {
      store_.beat();
      last_beat_ = Clock::now();
    }
    const std::size_t finished = open_.settled() - in_work();
    report(progress_,
           (static_cast<double>(finished) + crew_.fraction()) / static_cast<double>(open_.count()),
           fmt::format("{} of {} items", finished, open_.count()));
  }

  SweepStore& store_;
  const SweepRunOptions& options_;
  const Progress& progress_;
  OpenItems& open_;
  SweepCrew crew_;
  std::vector<MemberLoad> loads_;
  std::deque<ClaimedItem> ready_;  // ours, and given to nobody yet
  std::size_t computing_ = 0;
  SweepRun result_;
  Clock::time_point last_beat_ = Clock::now(), asked_all_at_ = Clock::now() - std::chrono::hours(1);
};

}  // namespace

bool SweepShard::holds(std::string_view key) const {
  return key_number(key) % static_cast<std::uint64_t>(count) ==
         static_cast<std::uint64_t>(index - 1);
}

std::optional<BrokenRule> SweepShard::broken_rule() const {
  if (count < 1) return broken("shard.count", count, "must be >= 1");
  if (index < 1 || index > count) return broken("shard.index", index, "must be in 1 .. count");
  return std::nullopt;
}

void SweepShard::validate() const { require(broken_rule()); }

void SweepRunOptions::validate() const {
  shard.validate();
  require(lease_s > 0.0, "lease_s", lease_s, "must be > 0");
  require(batch_s > 0.0, "batch_s", batch_s, "must be > 0");
  require(max_ranks_computing >= 1, "max_ranks_computing", max_ranks_computing, "must be >= 1");
}

SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options, const Progress& progress, SweepRanks* ranks) {
  options.validate();
  require(ranks == nullptr || ranks->rank() == 0, "rank", ranks == nullptr ? 0 : ranks->rank(),
          "must be 0: the others work_for_sweep()");
  OpenItems open(keys, options.shard);
  open.add_to(store, list, progress);
  return Runner(list, store, options, progress, open, ranks).run();
}

}  // namespace tofsmith

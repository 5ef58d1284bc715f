// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sweep/item_key.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_items_per_call = 4096;

/// Computes items on all threads in the background. The destructor stops the work.
class ItemBatch {
 public:
  ItemBatch(const WorkList& list, std::vector<ClaimedItem> items);
  ~ItemBatch();
  ItemBatch(const ItemBatch&) = delete;
  ItemBatch& operator=(const ItemBatch&) = delete;

  /// Returns new outcomes after at most `max_wait`.
  std::vector<ItemOutcome> wait(std::chrono::milliseconds max_wait);
  /// True when the work has ended; wait() may still return outcomes.
  bool is_done() const { return done_; }
  /// Returns the outcomes that wait() has not returned.
  std::vector<ItemOutcome> stop();
  /// Progress in [0, 1] of a batch of one item; 0 for larger batches.
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
  std::thread thread_;  // last, because it uses all members
};

std::string computed(const WorkItem& item, const Progress& progress) {
  if (!item.design)
    return item_result_json(evaluate(*item.code, item.camera, item.options, progress));
  // Standard codes with three or more taps compete with other numbers of exposures.
  const DesignResult result = design(item.camera, *item.design, progress);
  const int exposures = item.design->exposures.front();
  for (const Candidate* c : by_geometric_mean_error(result, item.camera.operating.measure()))
    if (c->code.exposures() == exposures) return item_result_json(c->error, &c->code);
  throw std::runtime_error(fmt::format("no code of {} exposures was found", exposures));
}

ItemOutcome outcome_of(const WorkList& list, const ClaimedItem& claimed, const Progress& progress) {
  ItemOutcome outcome{.key = claimed.key};
  const auto begin = std::chrono::steady_clock::now();
  try {
    const WorkItem item = list.item(claimed.item);
    if (item.key != claimed.key)
      throw IoError(list.spec().source_name,
                    "a file that the sweep reads has changed since it started");
    outcome.result = computed(item, progress);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

ItemBatch::ItemBatch(const WorkList& list, std::vector<ClaimedItem> items)
    : list_(list), items_(std::move(items)), thread_([this] { compute_all(); }) {}

ItemBatch::~ItemBatch() {
  stop_ = true;
  thread_.join();
}

std::vector<ItemOutcome> ItemBatch::wait(std::chrono::milliseconds max_wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, max_wait, [this] { return !outcomes_.empty() || done_; });
  return std::exchange(outcomes_, {});
}

std::vector<ItemOutcome> ItemBatch::stop() {
  stop_ = true;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return done_.load(); });
  return std::exchange(outcomes_, {});
}

void ItemBatch::compute_all() {
  parallel_for_indices(items_.size(), [&](std::size_t at) { compute(items_[at]); });
  const std::lock_guard lock(mutex_);
  done_ = true;
  changed_.notify_all();
}

void ItemBatch::compute(const ClaimedItem& claimed) {
  if (stop_) return;
  const bool is_alone = items_.size() == 1;
  const auto progress = [&](double fraction, std::string_view) {
    if (is_alone) fraction_ = fraction;
    return !stop_;
  };
  try {
    ItemOutcome outcome = outcome_of(list_, claimed, progress);
    const std::lock_guard lock(mutex_);
    outcomes_.push_back(std::move(outcome));
    changed_.notify_all();
  } catch (const Interrupted&) {  // from stop()
  }
}

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

std::vector<ItemOutcome> compute_items(const WorkList& list, std::span<const ClaimedItem> items) {
  std::vector<ItemOutcome> outcomes(items.size());
  parallel_for_indices(items.size(),
                       [&](std::size_t at) { outcomes[at] = outcome_of(list, items[at], {}); });
  return outcomes;
}

bool SweepShard::holds(std::string_view key) const {
  return key_number(key) % static_cast<std::uint64_t>(count) ==
         static_cast<std::uint64_t>(index - 1);
}

SweepRun run_sweep(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                   const SweepRunOptions& options, const Progress& progress) {
  check_fields(options);
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

SweepQueue::SweepQueue(const WorkList& list, std::span<const std::string> keys, SweepStore& store,
                       const SweepShard& shard, const Progress& progress)
    : keys_(keys), store_(store), items_(key_order(keys)) {
  std::erase_if(items_,
                [&](std::int64_t i) { return !shard.holds(keys[static_cast<std::size_t>(i)]); });
  size_ = items_.size();
  // The order of the store, which then grows at its end.
  const std::span<const std::int64_t> items(items_);
  for (std::size_t begin = 0; begin < items.size(); begin += max_items_per_call) {
    report(progress, 0.0, fmt::format("adding items: {} of {}", begin, items.size()));
    const auto part = items.subspan(begin, std::min(max_items_per_call, items.size() - begin));
    store_.add(keys_of(part), [&](std::size_t i) { return list.settings_json(part[i]); });
  }
  std::ranges::sort(items_);
}

SweepQueue::~SweepQueue() {
  try {
    store_.release(std::vector<std::string>(claimed_.begin(), claimed_.end()));
  } catch (const std::exception&) {  // the marks remain; other processes compute these items last
  }
}

std::vector<ClaimedItem> SweepQueue::claim(std::size_t max_items) {
  std::vector<ClaimedItem> claimed;
  while (claimed.empty() && left() > 0) {
    if (next_ == items_.size()) {
      items_ = std::exchange(running_, {});
      next_ = 0;
      takes_running_ = true;
    }
    const std::size_t count = std::min(max_items_per_call, items_.size() - next_);
    const std::vector<std::string> keys = keys_of(std::span(items_).subspan(next_, count));
    for (const ClaimAnswer answer : store_.claim(keys, max_items, takes_running_)) {
      const std::int64_t item = items_[next_++];
      if (answer == ClaimAnswer::running) running_.push_back(item);
      if (answer != ClaimAnswer::ours) continue;
      claimed.push_back({item, keys_[static_cast<std::size_t>(item)]});
      claimed_.insert(claimed.back().key);
    }
  }
  return claimed;
}

void SweepQueue::finish(std::span<const ItemOutcome> outcomes) {
  store_.finish(outcomes);
  for (const ItemOutcome& outcome : outcomes) claimed_.erase(outcome.key);
}

std::vector<std::string> SweepQueue::keys_of(std::span<const std::int64_t> items) const {
  std::vector<std::string> keys;
  keys.reserve(items.size());
  for (const std::int64_t item : items) keys.push_back(keys_[static_cast<std::size_t>(item)]);
  return keys;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "sweep/key_order.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_items_per_call = 4096;

}  // namespace

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/open_items.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sweep/key_order.hpp"

namespace tofsmith {

namespace {

/// Most items that a store is asked about, or told of, at a time.
constexpr std::size_t most_asked_at_once = 4096;

}  // namespace

OpenItems::OpenItems(std::span<const std::string> keys, const SweepShard& shard)
    : keys_(keys), items_(key_order(keys)) {
  std::erase_if(items_,
                [&](std::int64_t i) { return !shard.holds(keys[static_cast<std::size_t>(i)]); });
  count_ = items_.size();
}

void OpenItems::add_to(SweepStore& store, const WorkList& list, const Progress& progress) {
  // In the order of the keys, which is the store's own: then it grows at its end.
  const std::span<const std::int64_t> items(items_);
  for (std::size_t begin = 0; begin < items.size(); begin += most_asked_at_once) {
    report(progress, 0.0, fmt::format("adding items: {} of {}", begin, items.size()));
    const auto part = items.subspan(begin, std::min(most_asked_at_once, items.size() - begin));
    store.add(keys_of(part), [&](std::size_t i) { return list.settings_json(part[i]); });
  }
  std::ranges::sort(items_);
}

std::vector<ClaimedItem> OpenItems::claim(SweepStore& store, std::size_t most) {
  if (were_all_asked()) {  // go on with those that others had
    items_ = std::exchange(taken_, {});
    next_ = 0;
  }
  const std::size_t some = std::min(most_asked_at_once, items_.size() - next_);
  const std::vector<std::string> keys = keys_of(std::span(items_).subspan(next_, some));
  std::vector<ClaimedItem> ours;
  for (const ClaimAnswer answer : store.claim(keys, most)) {
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

}  // namespace tofsmith

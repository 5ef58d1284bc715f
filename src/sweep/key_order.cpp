// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep/key_order.hpp"

#include <algorithm>
#include <charconv>
#include <tuple>

namespace tofsmith {

std::uint64_t key_number(std::string_view key) {
  std::uint64_t number = 0;
  const std::string_view digits = key.substr(0, 16);
  std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return number;
}

std::vector<std::int64_t> key_order(std::span<const std::string> keys) {
  struct Entry {
    std::uint64_t number;  // decides nearly all comparisons
    std::int64_t place;
  };
  const auto key_of = [&](const Entry& entry) -> const std::string& {
    return keys[static_cast<std::size_t>(entry.place)];
  };
  std::vector<Entry> entries;
  entries.reserve(keys.size());
  for (const std::string& key : keys)
    entries.push_back({key_number(key), static_cast<std::int64_t>(entries.size())});
  std::ranges::sort(entries, [&](const Entry& a, const Entry& b) {
    if (a.number != b.number) return a.number < b.number;
    return std::tie(key_of(a), a.place) < std::tie(key_of(b), b.place);
  });
  std::vector<std::int64_t> order;
  order.reserve(entries.size());
  const Entry* before = nullptr;
  for (const Entry& entry : entries) {
    if (before == nullptr || before->number != entry.number || key_of(*before) != key_of(entry))
      order.push_back(entry.place);
    before = &entry;
  }
  return order;
}

}  // namespace tofsmith

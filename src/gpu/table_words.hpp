// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

class TableWords {
 public:
  explicit TableWords(std::vector<std::uint32_t>& words) : words_(words) {}

  /// @return offset of the table [words]
  template <typename Value>
  int add(std::span<const Value> table) {
    static_assert(sizeof(Value) % sizeof(std::uint32_t) == 0);
    constexpr std::size_t line = 16;  // words
    const std::size_t at = (words_.size() + line - 1) / line * line;
    require(at + table.size_bytes() / 4 < std::size_t{std::numeric_limits<int>::max()},
            "words of decoding tables", at, "must be below 2^31 on a device");
    words_.resize(at + table.size_bytes() / sizeof(std::uint32_t));
    if (!table.empty()) std::memcpy(&words_[at], table.data(), table.size_bytes());
    return static_cast<int>(at);
  }
  template <typename Value>
  int add(const std::vector<Value>& table) {
    return add(std::span<const Value>(table));
  }

 private:
  std::vector<std::uint32_t>& words_;
};

}  // namespace tofsmith

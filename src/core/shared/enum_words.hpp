// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Words for the values 0 to Count - 1.
template <typename Enum, std::size_t Count>
class EnumWords {
 public:
  /// @param type, field  names of the enumeration and of the setting
  template <typename... Words>
  constexpr EnumWords(std::string_view type, std::string_view field, Words... words)
      : type_(type), field_(field), words_{words...} {
    static_assert(sizeof...(words) == Count, "one word for each value");
  }

  constexpr EnumWords(std::string_view type, std::string_view field,
                      const std::array<std::string_view, Count>& words)
      : type_(type), field_(field), words_(words) {}

  std::span<const std::string_view, Count> all() const { return words_; }

  /// @throws std::invalid_argument if there is no such value
  std::string_view of(Enum value) const {
    const auto at = static_cast<std::size_t>(value);
    require(at < Count, type_, at, fmt::format("must be in [0, {}]", Count - 1));
    return words_[at];
  }

  /// @throws std::invalid_argument for any other word
  Enum parse(std::string_view word) const {
    return static_cast<Enum>(index_of_word(field_, words_, word));
  }

 private:
  std::string_view type_, field_;
  std::array<std::string_view, Count> words_;
};

}  // namespace tofsmith

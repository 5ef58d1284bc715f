// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Returns the words of an enumeration:
///
///   constexpr auto words_of(Fruit /*any*/) { return word_list("apple", "pear"); }
template <typename... Words>
constexpr std::array<std::string_view, sizeof...(Words)> word_list(Words... words) {
  return {words...};
}

/// An enumeration with words_of(), which returns words in the order of the values 0, 1, ...
template <typename Enum>
concept HasWords = std::is_enum_v<Enum> && requires(Enum any) {
  words_of(any).size();
};

template <HasWords Enum>
inline constexpr auto all_words = words_of(Enum{});

template <HasWords Enum>
inline constexpr auto all_values = [] {
  std::array<Enum, all_words<Enum>.size()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Enum>(i);
  return values;
}();

/// Returns the index of a word.
/// @throws InvalidArgument "field = word; must be a, b or c"
inline std::size_t index_of_word(std::string_view field, std::span<const std::string_view> words,
                                 std::string_view word) {
  std::string rule = "must be ";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return i;
    if (i > 0) rule += i + 1 < words.size() ? ", " : " or ";
    rule += words[i];
  }
  reject(field, word, rule);
}

/// Returns the usual word for a synonym, and other text unchanged. Enumerations with synonyms
/// overload it.
template <HasWords Enum>
constexpr std::string_view usual_word(Enum /*any*/, std::string_view name) {
  return name;
}

/// Returns the word of a value.
/// @throws InvalidArgument if the value has no word
template <HasWords Enum>
constexpr std::string_view name_of(Enum value) {
  constexpr std::size_t count = all_words<Enum>.size();
  const auto at = static_cast<std::size_t>(value);
  if (at >= count)
    reject("value of an enumeration", std::to_string(at),
           "must be in [0, " + std::to_string(count - 1) + "]");
  return all_words<Enum>[at];
}

/// @throws InvalidArgument for other words
template <HasWords Enum>
Enum parse_word(std::string_view field, std::string_view word) {
  return static_cast<Enum>(index_of_word(field, all_words<Enum>, usual_word(Enum{}, word)));
}

}  // namespace tofsmith

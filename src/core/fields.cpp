// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::size_t index_of_word(std::string_view field, std::span<const std::string_view> words,
                          std::string_view word) {
  const auto at = std::find(words.begin(), words.end(), word);
  if (at == words.end()) {
    const std::string others = fmt::format("{}", fmt::join(words.begin(), words.end() - 1, ", "));
    reject(field, word,
           others.empty() ? fmt::format("must be {}", words.back())
                          : fmt::format("must be {} or {}", others, words.back()));
  }
  return static_cast<std::size_t>(at - words.begin());
}

std::string full_help(std::string_view unit, std::string_view help, std::string_view only_with,
                      std::string_view if_absent) {
  std::string text(help);
  if (!unit.empty()) {
    std::size_t end_of_noun = text.size();
    for (const std::string_view mark : {";", ":", ". "})
      end_of_noun = std::min(end_of_noun, text.find(mark));
    text.insert(end_of_noun, fmt::format(" [{}]", unit));
  }
  if (!if_absent.empty()) text += fmt::format(" (default: {})", if_absent);
  if (!only_with.empty()) text += fmt::format("; only with {}", only_with);
  return text;
}

std::string error_name(std::string_view name) {
  for (const std::string_view end : {"_m", "_mde"})
    if (name.ends_with(end)) name.remove_suffix(end.size());
  return std::string(name) + "_se_m";
}

int scaled_count(int count, double effort, ByEffort by_effort) {
  return std::max(by_effort.min, static_cast<int>(std::lround(effort * count)));
}

}  // namespace tofsmith

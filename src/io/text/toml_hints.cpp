// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/toml_hints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

std::string_view line_of(std::string_view text, std::size_t line) {
  for (std::size_t i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find_first_of("\r\n"));
}

bool is_binary(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\n' && c != '\r' && c != '\t';
  });
}

/// Accepts words and file names, but not numbers.
bool is_word(std::string_view text) {
  return !text.empty() && !is_digit(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return is_letter_or_digit(c) ||
                  std::string_view("_-./ ").find(c) != std::string_view::npos;
         });
}

}  // namespace

std::string toml_hint(std::string_view text, std::size_t line) {
  if (is_binary(text)) return "; this is a binary file, and a text file was expected";
  const std::string_view whole = line_of(text, line);
  const std::size_t sign = whole.find('=');
  if (sign == std::string_view::npos)
    return trimmed(whole).starts_with('[') ? "" : "; expected key = value, or [table]";
  const std::string_view key = trimmed(whole.substr(0, sign));
  std::string_view value = trimmed(whole.substr(sign + 1, whole.find('#') - sign - 1));
  const std::string_view written = value;
  constexpr std::string_view common_bytes = "\xe2\x80";  // of typographic quotes
  if (value.starts_with(common_bytes)) return "; text needs straight quotes, such as \"mine\"";
  if (value.starts_with('"') && value.find('"', 1) == value.npos)
    return fmt::format("; text ends with a quote: {} = {}\"", key, value);
  if (is_word(value)) return fmt::format("; text needs quotes: {} = \"{}\"", key, value);
  if (!take_number(value) || value.empty()) return "";
  if (value.starts_with(',') && value.size() > 1 && is_digit(value[1]))
    return "; decimals have a point, such as 0.02";
  value = trimmed(value);
  if (!is_word(value)) return "";
  if (unit_of_key(key).empty()) return fmt::format("; {} is a plain number without a unit", key);
  return fmt::format("; a number with a unit needs quotes: {} = \"{}\"", key, written);
}

std::optional<std::string> with_quotes(const std::string& setting) {
  const std::size_t sign = setting.find('=');
  if (sign == std::string::npos) return std::nullopt;
  const std::size_t begin = setting.find_first_not_of(' ', sign + 1);
  if (begin == std::string::npos) return std::nullopt;
  const std::string value = setting.substr(begin);
  std::string_view word = value;
  take_number(word);
  if (!is_word(trimmed(word))) return std::nullopt;
  return fmt::format("{}\"{}\"", setting.substr(0, begin), value);
}

std::string key_suggestion(std::string_view unknown, std::string_view near) {
  const std::string_view unit = unit_of_key(near);
  const std::string_view name = near.substr(near.rfind('.') + 1);
  if (unit.empty() || unit == unit_of_key(unknown) || name == unknown)
    return fmt::format("did you mean {}?", near);
  return fmt::format("did you mean {}, in {}?", near, unit);
}

}  // namespace tofsmith

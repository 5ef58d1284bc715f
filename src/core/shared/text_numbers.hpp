// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

// Parsing independent of the locale.

/// Removes a number such as "-1.5e3" from the beginning of a text; none if it is missing or out of
/// range.
std::optional<double> take_number(std::string_view& text);

/// Parses all of `text`, which may begin with a plus sign.
std::optional<double> number_in(std::string_view text);

/// Removes blanks and line ends at the beginning and the end.
std::string_view trimmed(std::string_view text);

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_letter_or_digit(char c) { return is_letter(c) || is_digit(c); }
constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
/// In lower case: "Sample Interval" and "SAMPLE_INTERVAL" are equal.
std::string letters_and_digits(std::string_view text);
constexpr char upper_case(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// "[1, 2.5]".
template <typename Number>
std::string list_text(const std::vector<Number>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace tofsmith

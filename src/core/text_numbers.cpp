// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/text_numbers.hpp"

#include <charconv>
#include <system_error>
#include <version>

#ifndef __cpp_lib_to_chars
#include <cmath>
#include <cstdlib>
#include <string>
#endif

namespace tofsmith {

std::optional<double> take_number(std::string_view& text) {
#ifdef __cpp_lib_to_chars
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
#else
  // Emscripten lacks std::from_chars for doubles; strtod() ignores its locale.
  const std::string_view digits = text.substr(0, text.find_first_not_of("0123456789.e-+"));
  if (digits.empty() || digits.front() == '+') return std::nullopt;
  const std::string copy(digits);
  char* end = nullptr;
  const double number = std::strtod(copy.c_str(), &end);
  if (end == copy.c_str() || std::isinf(number)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - copy.c_str()));
  return number;
#endif
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const std::optional<double> number = take_number(text);
  return text.empty() ? number : std::nullopt;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string letters_and_digits(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (is_letter_or_digit(c)) word += lower_case(c);
  return word;
}

}  // namespace tofsmith

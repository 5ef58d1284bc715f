// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "session.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/core/words.hpp"

namespace tofsmith::apps {

/// Reads two numbers separated by a character, such as "3/8" or "1e3:1e5". Returns false for other
/// text.
template <typename Number>
bool read_number_pair(const std::string& text, char separator, Number& first, Number& second) {
  const std::size_t at = text.find(separator);
  return at != std::string::npos && CLI::detail::lexical_cast(text.substr(0, at), first) &&
         CLI::detail::lexical_cast(text.substr(at + 1), second);
}

/// Reads a number that must have a unit, such as "5mm" with the unit "m"; NaN for other text.
inline double number_with_unit(std::string_view text, std::string_view unit) {
  return text.ends_with(unit) ? number_in_unit(text, unit).value_or(NAN) : NAN;
}

/// Reads one number, or two separated by a colon: minimum and maximum. Returns false for other
/// text.
inline bool read_limits(const std::string& text, std::array<double, 2>& limits) {
  if (text.find(':') != std::string::npos) return read_number_pair(text, ':', limits[0], limits[1]);
  if (!CLI::detail::lexical_cast(text, limits[0])) return false;
  limits[1] = limits[0];
  return true;
}

/// Returns a validator that converts a value such as "20MHz" to a number in the option's unit, and
/// for integers "1e4" to "10000".
inline CLI::Validator number_in(std::string_view unit, bool is_integer = false) {
  CLI::Validator rewrite;
  rewrite.operation([unit, is_integer](std::string& text) {
    constexpr double max_integer = 1e15;
    double plain = 0.0;
    if (!is_integer && CLI::detail::lexical_cast(text, plain)) return std::string();
    const auto number = number_in_unit(text, unit);
    if (!number && unit.empty() && !is_integer) return std::string();  // the next check reports it
    if (!number)
      return fmt::format("found {}; expected {}", text,
                         unit.empty() ? "an integer" : number_rule(unit));
    if (!is_integer) {
      text = fmt::format("{}", *number);
    } else if (std::abs(*number) <= max_integer) {
      if (*number != std::trunc(*number)) return fmt::format("found {}; expected an integer", text);
      text = fmt::format("{:.0f}", *number);
    }
    return std::string();
  });
  return rewrite;
}

/// Returns a validator that rejects other numbers with a message such as "found -1; must be > 0".
inline CLI::Validator number_that(const std::string& rule, std::function<bool(double)> holds) {
  return {[rule, holds = std::move(holds)](const std::string& text) {
            double value = 0.0;
            return CLI::detail::lexical_cast(text, value) && holds(value)
                       ? std::string()
                       : fmt::format("found {}; must be {}", text, rule);
          },
          rule};
}

/// Returns a validator that accepts one of these words and suggests similar words for others.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
  const CLI::Validator member = CLI::IsMember(words);
  CLI::Validator check = member;
  return check.operation([member, words](std::string& word) {
    std::string problem = member(word);
    if (problem.empty()) return problem;
    const std::string near = nearest_word(word, words);
    return near.empty() ? problem : problem + "; did you mean " + near + "?";
  });
}
template <HasWords Enum>
CLI::Validator one_of() {
  return one_of({all_words<Enum>.begin(), all_words<Enum>.end()});
}

inline CLI::Validator integer_in(int min, int max) {
  return number_that(fmt::format("in [{}, {}]", min, max),
                     [min, max](double value) { return value >= min && value <= max; });
}

/// The following validators reject NaN.
inline CLI::Validator positive_number() {
  return number_that("> 0 and finite",
                     [](double value) { return value > 0.0 && std::isfinite(value); });
}
inline CLI::Validator positive_number(double max) {
  return number_that(fmt::format("> 0 and at most {}", max),
                     [max](double value) { return value > 0.0 && value <= max; });
}
inline CLI::Validator number_from_0_on() {
  return number_that(">= 0 and finite",
                     [](double value) { return value >= 0.0 && std::isfinite(value); });
}

/// Returns a validator for a share in [0, 1), which converts a percentage: "1%" to "0.01".
inline CLI::Validator share_or_percentage() {
  return {[](std::string& text) {
            constexpr std::string_view rule = "a share in [0, 1), such as 0.01 or 1%";
            const bool is_percentage = text.ends_with('%');
            double value = 0.0;
            if (!CLI::detail::lexical_cast(is_percentage ? text.substr(0, text.size() - 1) : text,
                                           value) ||
                !std::isfinite(value))
              return fmt::format("found {}; must be {}", text, rule);
            if (is_percentage) value /= 100.0;
            if (!(value >= 0.0 && value < 1.0))
              return fmt::format("found {}; must be {}", text, rule);
            text = fmt::format("{}", value);
            return std::string();
          },
          ""};
}

}  // namespace tofsmith::apps

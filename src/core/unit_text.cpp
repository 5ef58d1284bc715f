// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/unit_text.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/shared/text_numbers.hpp"

namespace tofsmith {

namespace {

/// "klx": `factor` times `base`.
struct PrefixedUnit {
  double factor;
  std::string_view base;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Spelling of unit_of_key().
std::string_view spelling(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> others = {
      {{"lux", "lx"},
       {"klux", "klx"},
       {"deg", "degrees"},
       {"C", "degrees C"},
       {"degC", "degrees C"},
       {"\u00b0C", "degrees C"},
       {"Ohm", "ohm"},
       {"kOhm", "kohm"},
       {"\u00b5m", "um"}}};
  for (const auto& [other, usual] : others)
    if (unit == other) return usual;
  return unit;
}

/// Splits a unit with a prefix.
PrefixedUnit base_of(std::string_view unit) {
  if (unit == "klx") return {1e3, "lx"};
  if (unit == "MB") return {1e6, "B"};
  return {1.0, unit};
}

/// Factor from `written` to `unit`; none if the base units differ.
std::optional<double> factor_of(std::string_view written, const PrefixedUnit& unit) {
  constexpr std::array<std::pair<std::string_view, double>, 11> prefixes = {{{"", 1.0},
                                                                             {"f", 1e-15},
                                                                             {"p", 1e-12},
                                                                             {"n", 1e-9},
                                                                             {"u", 1e-6},
                                                                             {"\u00b5", 1e-6},
                                                                             {"m", 1e-3},
                                                                             {"c", 1e-2},
                                                                             {"k", 1e3},
                                                                             {"M", 1e6},
                                                                             {"G", 1e9}}};
  for (const auto& [prefix, factor] : prefixes)
    if (written.starts_with(prefix) && written.substr(prefix.size()) == unit.base)
      return factor / unit.factor;
  return std::nullopt;
}

}  // namespace

std::optional<double> number_in_unit(std::string_view text, std::string_view unit) {
  text = trimmed(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const std::optional<double> number = take_number(text);
  if (!number) return std::nullopt;
  const std::string_view written = spelling(trimmed(text));
  if (written.empty() || written == unit) return number;
  if (unit.empty()) return std::nullopt;
  const auto factor = factor_of(written, base_of(unit));
  if (!factor) return std::nullopt;
  // Division by a power of ten is exact where multiplication by its inverse is not.
  return *factor < 1.0 ? *number / (1.0 / *factor) : *number * *factor;
}

std::string number_rule(std::string_view unit) {
  if (unit.empty()) return "a number";
  return fmt::format("a number, or one with its unit such as 2{}", unit == "Hz" ? "MHz" : unit);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/shared/text_numbers.hpp"

namespace tofsmith {

std::string_view unit_of_key(std::string_view name) {
  // Longer endings come first: "_e_per_s" also ends with "_s".
  constexpr std::array<std::pair<std::string_view, std::string_view>, 25> units = {{
      {"_e_per_s", "e/s"},
      {"_m_per_s", "m/s"},
      {"_deg_per_s", "degrees/s"},
      {"_e_per_dn", "e/DN"},
      {"_w_per_m2_nm", "W/m2/nm"},
      {"_m_per_c", "m/degree C"},
      {"_per_c", "1/degree C"},
      {"_hz", "Hz"},
      {"_px", "px"},
      {"_deg", "degrees"},
      {"_klux", "klx"},
      {"_bits", "bits"},
      {"_dn", "DN"},
      {"_mb", "MB"},
      {"_ohm", "ohm"},
      {"_percent", "%"},
      {"_periods", "periods"},
      {"_sigma", "standard deviations"},
      {"_v", "V"},
      {"_s", "s"},
      {"_e", "e"},
      {"_m", "m"},
      {"_w", "W"},
      {"_c", "degrees C"},
      {"_points", "points"},
  }};
  for (const auto& [ending, unit] : units)
    if (name.ends_with(ending)) return unit;
  return "";
}

std::string plain_number(double value, int digits) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  constexpr int max_decimals = 9;
  const double size = std::abs(value);
  const int before_point = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
  return fmt::format("{:.{}f}", value, std::clamp(digits - before_point, 0, max_decimals));
}

std::string length_text(double metres) {
  const double size = std::abs(metres);
  if (size < 1e-3) return plain_number(metres * 1e6, 3) + " um";
  if (size < 1.0) return plain_number(metres * 1e3, 3) + " mm";
  return plain_number(metres, 3) + " m";
}

std::string estimate_text(const Estimate& estimate, double unit, int digits) {
  return fmt::format("{} ± {}", plain_number(estimate.value / unit, digits),
                     plain_number(estimate.standard_error / unit, 2));
}

std::string estimate_mm_text(const Estimate& error_m) { return estimate_text(error_m, 1e-3, 4); }

double wrap(double position, double period) {
  const double wrapped = position - period * std::floor(position / period);
  return wrapped < period ? wrapped : 0.0;  // rounding may give exactly the end point
}

double circular_difference(double to, double from, double period) {
  return wrap(to - from + 0.5 * period, period) - 0.5 * period;
}

namespace {

/// "klx": `factor` times `base`.
struct PrefixedUnit {
  double factor;
  std::string_view base;
};

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

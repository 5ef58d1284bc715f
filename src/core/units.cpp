// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

}  // namespace tofsmith

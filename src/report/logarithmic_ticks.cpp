// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/logarithmic_ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/shared/text_numbers.hpp"

namespace tofsmith::plotly {
namespace {

/// Within a factor of 5: multiples of 1, 2 or 5 times a power of ten, about five of them.
std::vector<Tick> round_multiples(const ValueRange& range) {
  constexpr double rounding = 1e-9;  // values closer than that are one
  const double width = std::max(range.high - range.low, rounding * range.high);
  double step = std::pow(10.0, std::floor(std::log10(width)) - 1.0);
  for (const double factor : {2.0, 2.5, 2.0, 2.0, 2.5})
    if (width / step > 6.0) step *= factor;
  std::vector<Tick> ticks;
  const double first = std::ceil(range.low / step - 1e-6);
  const int count = 1 + static_cast<int>(std::floor(range.high / step + 1e-6 - first));
  for (int i = 0; i < count; ++i) {
    const std::string text = fmt::format("{:.6g}", (first + i) * step);
    ticks.push_back({*number_in(text), text});
  }
  return ticks;
}

std::string power_text(int digit, int exponent) {
  return digit == 1 ? fmt::format("10<sup>{}</sup>", exponent)
                    : fmt::format("{}·10<sup>{}</sup>", digit, exponent);
}

}  // namespace

std::vector<Tick> logarithmic_ticks(const ValueRange& range) {
  const double decades = std::log10(range.high / range.low);
  if (decades < 0.7) return round_multiples(range);
  const bool is_plain = range.low >= 0.99e-3 && range.high <= 1.01e3;
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  // A bar or axis has room for about eight labels.
  const int every = 1 + (last - first) / 8;
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, exponent);
      const bool is_wanted = digit == 1 ? exponent % every == 0 : decades <= 2.2;
      if (!is_wanted || value < range.low * 0.999 || value > range.high * 1.001) continue;
      ticks.push_back(
          {value, is_plain ? fmt::format("{:.3g}", value) : power_text(digit, exponent)});
    }
  }
  return ticks;
}

}  // namespace tofsmith::plotly

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/logarithmic_ticks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace tofsmith::plotly {
namespace {

std::vector<Tick> evenly_spaced(const ValueRange& range) {
  constexpr int count = 5;
  std::vector<Tick> ticks;
  for (int i = 0; i < count; ++i) {
    const double value = range.low * std::pow(range.high / range.low, i / (count - 1.0));
    const std::string text = fmt::format("{:.3g}", value);
    ticks.push_back({std::strtod(text.c_str(), nullptr), text});
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
  if (decades < 1) return evenly_spaced(range);
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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/colour_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "report/logarithmic_ticks.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::plotly {
namespace {

/// The values that the scale can show, in order.
std::vector<float> shown_values(const ColourScale& scale, std::span<const float> values) {
  std::vector<float> shown;
  for (const float value : values)
    if (std::isfinite(value) && (!scale.logarithmic || value > 0)) shown.push_back(value);
  if (scale.map == ColourMap::diverging)
    for (float& value : shown) value = std::abs(value);
  std::ranges::sort(shown);
  return shown;
}

ValueRange fitted_range(const ColourScale& scale, std::span<const float> values) {
  if (scale.range) return *scale.range;
  const auto shown = shown_values(scale, values);
  if (shown.empty()) return {scale.map == ColourMap::diverging ? -1.0 : 0.1, 1};
  const auto at = [&](double fraction) {
    const auto last = static_cast<double>(shown.size() - 1);
    return static_cast<double>(shown[static_cast<std::size_t>(std::round(fraction * last))]);
  };
  double low = at(scale.clip_fraction);
  double high = at(1 - scale.clip_fraction);
  if (scale.map == ColourMap::diverging) low = -high;
  if (high <= low) {  // one value everywhere: any range around it will do
    const double half = low == 0 ? 1 : std::abs(low) / 2;
    return {low - half, high + half};
  }
  return {low, high};
}

/// Stops of a scale from blue over white to red whose lightness falls evenly to both sides.
Json diverging_stops() {
  static constexpr std::array colours = {"#08306b", "#1f6eb3", "#6baed6", "#c6dcee", "#f7f7f5",
                                         "#f6d0b8", "#ec8f60", "#c8431f", "#7a0f0a"};
  Json stops = Json::array();
  for (std::size_t i = 0; i < colours.size(); ++i)
    stops.push_back({static_cast<double>(i) / (colours.size() - 1), colours[i]});
  return stops;
}

}  // namespace

ColourAxis::ColourAxis(const ColourScale& scale, std::span<const float> values) : scale_(scale) {
  require(!(scale.logarithmic && scale.map == ColourMap::diverging), "ColourScale::logarithmic",
          true, "must be false for a diverging map");
  require(scale.clip_fraction >= 0 && scale.clip_fraction < 0.5, "ColourScale::clip_fraction",
          scale.clip_fraction, "must be in [0, 0.5)");
  range_ = fitted_range(scale, values);
  require(range_.low < range_.high, "ColourScale::range.low", range_.low,
          "must be below range.high");
  require(!scale.logarithmic || range_.low > 0, "ColourScale::range.low", range_.low,
          "must be > 0 on a logarithmic scale");
}

double ColourAxis::to_trace(double value) const {
  if (!scale_.logarithmic) return value;
  return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

double ColourAxis::resolution() const {
  constexpr double steps = 2 * 256;
  return (to_trace(range_.high) - to_trace(range_.low)) / steps;
}

bool ColourAxis::is_dark(double value) const {
  const double low = to_trace(range_.low);
  const double place = (to_trace(value) - low) / (to_trace(range_.high) - low);
  if (scale_.map == ColourMap::diverging) return place < 0.2 || place > 0.8;
  return place < 0.55;
}

Json ColourAxis::layout() const {
  static constexpr std::array names = {"Viridis", "Cividis"};
  Json colour_bar = {
      {"title", {{"text", text(axis_title(scale_.label, scale_.unit))}, {"side", "right"}}}};
  if (scale_.logarithmic) {
    for (const Tick& tick : logarithmic_ticks(range_)) {
      colour_bar["tickvals"].push_back(number(std::log10(tick.value)));
      colour_bar["ticktext"].push_back(tick.text);
    }
  }
  Json colours = diverging_stops();
  if (scale_.map != ColourMap::diverging) colours = names[static_cast<std::size_t>(scale_.map)];
  return {{"colorscale", colours},
          {"cmin", number(to_trace(range_.low))},
          {"cmax", number(to_trace(range_.high))},
          {"colorbar", colour_bar}};
}

std::string ColourAxis::hover(const std::string& variable) const {
  const std::string shown = scale_.logarithmic ? fmt::format("10^%{{{}:.2f}}", variable)
                                               : fmt::format("%{{{}:.4g}}", variable);
  return scale_.unit.empty() ? shown : fmt::format("{} {}", shown, text(scale_.unit));
}

}  // namespace tofsmith::plotly

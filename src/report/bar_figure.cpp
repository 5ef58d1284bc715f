// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/bar_figure.hpp"

#include <fmt/format.h>

#include <utility>

#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

Json colours_of(const BarSeries& series, const std::vector<LineStyle>& category_styles) {
  if (category_styles.empty()) return series.style.colour;
  Json colours = Json::array();
  for (const LineStyle& style : category_styles) colours.push_back(style.colour);
  return colours;
}

/// What a dash is to a line, hatching is to a bar.
const char* pattern_name(Dash dash) {
  switch (dash) {
    case Dash::dash:
      return "/";
    case Dash::dot:
      return ".";
    case Dash::dash_dot:
      return "x";
    default:
      return "";
  }
}

Json patterns_of(const BarSeries& series, const std::vector<LineStyle>& category_styles) {
  if (category_styles.empty()) return pattern_name(series.style.dash);
  Json patterns = Json::array();
  for (const LineStyle& style : category_styles) patterns.push_back(pattern_name(style.dash));
  return patterns;
}

}  // namespace

Figure bar_figure(FigureText text, const std::vector<std::string>& categories,
                  const std::vector<BarSeries>& series, const Axis& value_axis,
                  const std::vector<LineStyle>& category_styles) {
  require(!categories.empty(), "categories.size", categories.size(), "must be >= 1");
  require(!series.empty(), "series.size", series.size(), "must be >= 1");
  const std::string rule = fmt::format("must equal categories.size = {}", categories.size());
  require(category_styles.empty() || category_styles.size() == categories.size(),
          "category_styles.size", category_styles.size(), rule + " or be 0");
  Json names = Json::array();
  for (const std::string& category : categories) names.push_back(plotly::text(category));

  Json data = Json::array();
  std::vector<double> all_values;
  for (const BarSeries& one : series) {
    all_values.insert(all_values.end(), one.values.begin(), one.values.end());
    require(one.values.size() == categories.size(), "BarSeries::values.size", one.values.size(),
            rule);
    require(one.errors.empty() || one.errors.size() == categories.size(), "BarSeries::errors.size",
            one.errors.size(), rule + " or be 0");
    Json trace = {{"type", value_axis.logarithmic ? "scatter" : "bar"},
                  {"name", plotly::text(one.name)},
                  {"x", plotly::numbers(one.values)},
                  {"y", names},
                  {"marker", {{"color", colours_of(one, category_styles)}}},
                  {"hovertemplate", "%{y}: %{x:.4g}"}};
    if (value_axis.logarithmic) {
      trace["mode"] = "markers";
      trace["marker"]["size"] = 9;
    } else {
      trace["orientation"] = "h";
      trace["marker"]["pattern"] = {
          {"shape", patterns_of(one, category_styles)}, {"fillmode", "overlay"}, {"size", 7}};
    }
    if (!one.errors.empty())
      trace["error_x"] = {{"type", "data"},
                          {"array", plotly::numbers(one.errors)},
                          {"thickness", 1.4},
                          {"width", 4},
                          {"color", "#000000"}};
    data.push_back(trace);
  }

  Json y = {{"type", "category"}, {"autorange", "reversed"},
            {"automargin", true}, {"showgrid", value_axis.logarithmic},
            {"ticks", "outside"}, {"tickcolor", "rgba(0,0,0,0)"}};
  const Json layout = {{"xaxis", plotly::axis(value_axis, all_values)},
                       {"yaxis", y},
                       {"barmode", "group"},
                       {"bargap", 0.35},
                       {"showlegend", series.size() > 1}};
  const double row_px =
      value_axis.logarithmic ? 30 : 18 + 14.0 * static_cast<double>(series.size());
  return plotly::figure(std::move(text), data, layout,
                        {.fixed_px = 100 + row_px * static_cast<double>(categories.size())});
}

}  // namespace tofsmith

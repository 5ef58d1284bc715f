// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/line_figure.hpp"

#include <set>
#include <utility>

#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

/// The series with the point that closes its period, if it has one.
Series closed(Series series) {
  if (!series.period || series.x.empty()) return series;
  series.x.push_back(series.x.front() + *series.period);
  series.y.push_back(series.y.front());
  if (!series.y_error.empty()) series.y_error.push_back(series.y_error.front());
  return series;
}

Json trace_of(const Series& open_series) {
  require(open_series.x.size() == open_series.y.size(), "Series::y.size", open_series.y.size(),
          "must equal x.size = " + std::to_string(open_series.x.size()));
  require(open_series.y_error.empty() || open_series.y_error.size() == open_series.y.size(),
          "Series::y_error.size", open_series.y_error.size(), "must be 0 or equal y.size");
  const Series series = closed(open_series);
  const bool has_line = series.mark != Mark::markers;
  const bool has_markers = series.mark == Mark::markers || series.mark == Mark::line_and_markers;
  Json trace = {{"type", "scatter"},
                {"name", plotly::text(series.name)},
                {"mode", !has_line     ? "markers"
                         : has_markers ? "lines+markers"
                                       : "lines"},
                {"x", plotly::numbers(series.x)},
                {"y", plotly::numbers(series.y)},
                {"line", plotly::line(series.style)},
                {"hovertemplate", "%{x:.4g}, %{y:.4g}"}};
  if (series.mark == Mark::steps) trace["line"]["shape"] = "hv";
  if (has_markers) trace["marker"] = {{"color", series.style.colour}, {"size", 6}};
  if (!series.y_error.empty()) {
    trace["error_y"] = {{"type", "data"},
                        {"array", plotly::numbers(series.y_error)},
                        {"color", series.style.colour},
                        {"thickness", 1.2},
                        {"width", 3}};
  }
  return trace;
}

/// [low, high] of panel `index` of `count` along one direction, `gap` between neighbours.
std::pair<double, double> panel_domain(int index, int count, double gap) {
  const double size = (1 - gap * (count - 1)) / count;
  return {index * (size + gap), index * (size + gap) + size};
}

Json row_title(const std::string& plain, double y) {
  return {{"text", plotly::text(plain)},
          {"x", 1.0},
          {"xref", "paper"},
          {"xanchor", "left"},
          {"xshift", 6},
          {"y", plotly::number(y)},
          {"yref", "paper"},
          {"yanchor", "middle"},
          {"textangle", 90},
          {"showarrow", false}};
}

}  // namespace

Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y) {
  require(!series.empty(), "series.size", series.size(), "must be >= 1");
  Json data = Json::array();
  for (const Series& one : series) data.push_back(trace_of(one));
  const Json layout = {
      {"xaxis", plotly::axis(x)}, {"yaxis", plotly::axis(y)}, {"showlegend", series.size() > 1}};
  return plotly::figure(std::move(text), data, layout, {.fixed_px = 400});
}

Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows) {
  require(!columns.empty(), "columns.size", columns.size(), "must be >= 1");
  require(!rows.empty(), "rows.size", rows.size(), "must be >= 1");
  const int column_count = static_cast<int>(columns.size());
  const int row_count = static_cast<int>(rows.size());
  constexpr double column_gap = 0.08;
  constexpr double row_height_px = 96;
  const double row_gap = row_count > 1 ? 0.14 / row_count : 0;

  Json data = Json::array();
  Json layout = {{"annotations", Json::array()}, {"margin", {{"r", 28}}}};
  std::set<std::string> names;
  for (int r = 0; r < row_count; ++r) {
    const PanelRow& row = rows[static_cast<std::size_t>(r)];
    require(row.panels.size() == columns.size(), "PanelRow::panels.size", row.panels.size(),
            "must equal columns.size = " + std::to_string(column_count));
    const auto [bottom, top] = panel_domain(row_count - 1 - r, row_count, row_gap);
    for (int c = 0; c < column_count; ++c) {
      const PanelColumn& column = columns[static_cast<std::size_t>(c)];
      const auto [left, right] = panel_domain(c, column_count, column_gap);
      const int index = r * column_count + c;
      // Panels of a column follow the axes of its first panel; only the last row names x.
      Json x = plotly::axis(column.x);
      Json y = plotly::axis(column.y);
      x["anchor"] = plotly::axis_name("y", index);
      y["anchor"] = plotly::axis_name("x", index);
      x["domain"] = {plotly::number(left), plotly::number(right)};
      y["domain"] = {plotly::number(bottom), plotly::number(top)};
      y["nticks"] = 4;
      x["nticks"] = 6;
      if (r > 0) {
        x["matches"] = plotly::axis_name("x", c);
        y["matches"] = plotly::axis_name("y", c);
      }
      if (r + 1 < row_count) {
        x.erase("title");
        x["showticklabels"] = false;
      }
      if (r != row_count / 2) y.erase("title");
      layout[plotly::axis_key("x", index)] = x;
      layout[plotly::axis_key("y", index)] = y;
      for (const Series& series : row.panels[static_cast<std::size_t>(c)]) {
        Json trace = trace_of(series);
        trace["xaxis"] = plotly::axis_name("x", index);
        trace["yaxis"] = plotly::axis_name("y", index);
        trace["legendgroup"] = trace["name"];
        trace["showlegend"] = names.insert(series.name).second;
        data.push_back(trace);
      }
      if (r == 0 && !column.title.empty())
        layout["annotations"].push_back(plotly::panel_title(column.title, (left + right) / 2, 1));
    }
    if (!row.title.empty())
      layout["annotations"].push_back(row_title(row.title, (bottom + top) / 2));
  }
  layout["showlegend"] = names.size() > 1;
  return plotly::figure(
      std::move(text), data, layout,
      {.fixed_px = 110 + row_height_px * row_count, .min_width_px = 210.0 * column_count});
}

}  // namespace tofsmith

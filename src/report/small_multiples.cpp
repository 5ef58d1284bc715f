// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

constexpr double column_gap = 0.1;  // share of the width, between columns
constexpr double row_height_px = 96;
constexpr double single_row_height_px = 240;
constexpr double legend_lift_px = 24;  // the legend stands above the column titles

/// [low, high] of panel `index` of `count` along one direction, `gap` between neighbours.
std::pair<double, double> panel_domain(int index, int count, double gap) {
  const double size = (1 - gap * (count - 1)) / count;
  return {index * (size + gap), index * (size + gap) + size};
}

/// Text turned by `angle` degrees, beside the point (x, y) of the paper.
Json turned_title(const std::string& plain, double x, double y, int angle, int shift_px) {
  return {{"text", plotly::text(plain)},
          {"x", plotly::number(x)},
          {"xref", "paper"},
          {"xanchor", shift_px < 0 ? "right" : "left"},
          {"xshift", shift_px},
          {"y", plotly::number(y)},
          {"yref", "paper"},
          {"yanchor", "middle"},
          {"textangle", angle},
          {"showarrow", false}};
}

/// Axes "x" and "y" of the panel (row, column) at this domain. Panels of a column follow the axes
/// of its first panel, only the last row names x, and y is named once beside the column.
struct PanelAxes {
  Json x;
  Json y;
};

PanelAxes panel_axes(const PanelColumn& column, const std::vector<Series>& series, int index,
                     int columns, bool is_last_row) {
  PanelAxes axes{plotly::axis(column.x, plotly::drawn(series, &Series::x)),
                 plotly::axis(column.y, plotly::drawn(series, &Series::y))};
  axes.x["anchor"] = plotly::axis_name("y", index);
  axes.y["anchor"] = plotly::axis_name("x", index);
  axes.x["nticks"] = 6;
  axes.y["nticks"] = 4;
  axes.y.erase("title");
  if (index >= columns) {
    axes.x["matches"] = plotly::axis_name("x", index % columns);
    axes.y["matches"] = plotly::axis_name("y", index % columns);
  }
  if (!is_last_row) {
    axes.x.erase("title");
    axes.x["showticklabels"] = false;
  }
  return axes;
}

}  // namespace

Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows) {
  require(!columns.empty(), "columns.size", columns.size(), "must be >= 1");
  require(!rows.empty(), "rows.size", rows.size(), "must be >= 1");
  const int column_count = static_cast<int>(columns.size());
  const int row_count = static_cast<int>(rows.size());

  Json data = Json::array();
  Json titles = Json::array();
  Json layout;
  std::set<std::string> names;
  for (int r = 0; r < row_count; ++r) {
    const PanelRow& row = rows[static_cast<std::size_t>(r)];
    require(row.panels.size() == columns.size(), "PanelRow::panels.size", row.panels.size(),
            fmt::format("must equal columns.size = {}", column_count));
    const auto [bottom, top] = panel_domain(row_count - 1 - r, row_count, 0.14 / row_count);
    titles.push_back(turned_title(row.title, 1, (bottom + top) / 2, 90, 6));
    for (int c = 0; c < column_count; ++c) {
      const auto& panel = row.panels[static_cast<std::size_t>(c)];
      const auto [left, right] = panel_domain(c, column_count, column_gap);
      const int index = r * column_count + c;
      PanelAxes axes = panel_axes(columns[static_cast<std::size_t>(c)], panel, index, column_count,
                                  r + 1 == row_count);
      axes.x["domain"] = {plotly::number(left), plotly::number(right)};
      axes.y["domain"] = {plotly::number(bottom), plotly::number(top)};
      layout[plotly::axis_key("x", index)] = std::move(axes.x);
      layout[plotly::axis_key("y", index)] = std::move(axes.y);
      for (const Series& series : panel) {
        Json trace = plotly::trace_of(series);
        trace["xaxis"] = plotly::axis_name("x", index);
        trace["yaxis"] = plotly::axis_name("y", index);
        trace["legendgroup"] = trace["name"];
        trace["showlegend"] = names.insert(series.name).second;
        data.push_back(std::move(trace));
      }
    }
  }
  for (int c = 0; c < column_count; ++c) {
    const PanelColumn& column = columns[static_cast<std::size_t>(c)];
    const auto [left, right] = panel_domain(c, column_count, column_gap);
    titles.push_back(plotly::panel_title(column.title, (left + right) / 2, 1));
    titles.push_back(turned_title(axis_title(column.y.label, column.y.unit), left, 0.5, -90,
                                  column.y.logarithmic ? -46 : -30));
  }
  layout["annotations"] = std::move(titles);
  layout["showlegend"] = names.size() > 1;
  const double rows_px = row_count == 1 ? single_row_height_px : row_height_px * row_count;
  layout["legend"] = {{"y", plotly::number(1 + legend_lift_px / rows_px)}};
  layout["margin"] = {{"r", 28}};
  // Logarithmic ticks are longer.
  if (columns.front().y.logarithmic) layout["margin"]["l"] = 76;
  return plotly::figure(std::move(text), data, layout,
                        {.fixed_px = 130 + rows_px, .min_width_px = 210.0 * column_count});
}

}  // namespace tofsmith

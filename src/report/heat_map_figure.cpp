// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/colour_axis.hpp"
#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

constexpr double cell_px = 42;  // least width that holds a value

/// Two significant digits, as short as a cell needs them.
std::string cell_text(double value) {
  const double size = std::abs(value);
  if (!std::isfinite(value)) return "";
  if (size != 0 && (size < 1e-3 || size >= 1e4)) return fmt::format("{:.1e}", value);
  const int decimals =
      size == 0 ? 0 : std::max(0, 1 - static_cast<int>(std::floor(std::log10(size))));
  return fmt::format("{:.{}f}", value, decimals);
}

Json category_axis(const CategoryAxis& category, bool has_title, bool has_ticks) {
  Json places = Json::array();
  Json ticks = Json::array();
  for (std::size_t i = 0; i < category.ticks.size(); ++i) {
    places.push_back(i);
    ticks.push_back(plotly::text(category.ticks[i]));
  }
  Json axis = {{"tickvals", places},   {"ticktext", ticks}, {"showgrid", false},
               {"showline", false},    {"ticks", ""},       {"showticklabels", has_ticks},
               {"constrain", "domain"}};
  if (has_title) axis["title"] = plotly::title(axis_title(category.label, category.unit));
  return axis;
}

}  // namespace

Figure heat_map_figure(FigureText text, const std::vector<HeatMap>& maps, const CategoryAxis& x,
                       const CategoryAxis& y, const ColourScale& colours,
                       const HeatMapOptions& options) {
  require(!maps.empty(), "maps.size", maps.size(), "must be >= 1");
  require(options.columns >= 1, "HeatMapOptions::columns", options.columns, "must be >= 1");
  std::vector<float> all_values;
  for (const HeatMap& map : maps) {
    require(map.values.rows() == std::ssize(y.ticks), "HeatMap::values.rows", map.values.rows(),
            fmt::format("must equal y.ticks.size = {}", y.ticks.size()));
    require(map.values.cols() == std::ssize(x.ticks), "HeatMap::values.cols", map.values.cols(),
            fmt::format("must equal x.ticks.size = {}", x.ticks.size()));
    for (const double value : map.values.reshaped())
      all_values.push_back(static_cast<float>(value));
  }
  const plotly::ColourAxis colour_axis(colours, all_values);
  const plotly::PanelLayout panels(static_cast<int>(maps.size()), options.columns, 0.03);
  const double panel_px = 60 + 30.0 * static_cast<double>(y.ticks.size());
  const double plot_px =
      panels.rows() * (panel_px + plotly::panel_title_px) - plotly::panel_title_px;
  const double row_gap = plotly::panel_title_px / plot_px;

  Json data = Json::array();
  Json layout = {{"coloraxis", colour_axis.layout()}, {"annotations", Json::array()}};
  for (int p = 0; p < std::ssize(maps); ++p) {
    const HeatMap& map = maps[static_cast<std::size_t>(p)];
    Json z = Json::array(), hover = Json::array();
    for (Eigen::Index row = 0; row < map.values.rows(); ++row) {
      z.push_back(Json::array());
      hover.push_back(Json::array());
      for (Eigen::Index column = 0; column < map.values.cols(); ++column) {
        const double value = map.values(row, column);
        z.back().push_back(plotly::number(colour_axis.to_trace(value)));
        hover.back().push_back(fmt::format("{:.4g} {}", value, plotly::text(colours.unit)));
        if (!options.show_values || !std::isfinite(value)) continue;
        layout["annotations"].push_back(
            {{"text", cell_text(value)},
             {"x", column},
             {"y", row},
             {"xref", plotly::axis_name("x", p)},
             {"yref", plotly::axis_name("y", p)},
             {"showarrow", false},
             {"yanchor", "middle"},
             {"font",
              {{"size", 11}, {"color", colour_axis.is_dark(value) ? "#ffffff" : "#111111"}}}});
      }
    }
    data.push_back({{"type", "heatmap"},
                    {"z", z},
                    {"text", hover},
                    {"hoverongaps", false},
                    {"hovertemplate", "%{text}<extra></extra>"},
                    {"coloraxis", "coloraxis"},
                    {"xgap", 1},
                    {"ygap", 1},
                    {"xaxis", plotly::axis_name("x", p)},
                    {"yaxis", plotly::axis_name("y", p)}});
    const bool lowest = p + panels.columns() >= std::ssize(maps);
    const bool leftmost = panels.column(p) == 0;
    panels.place(layout, p, row_gap, map.title, category_axis(x, lowest, lowest),
                 category_axis(y, leftmost, leftmost));
  }
  layout["margin"] = {{"r", plotly::colour_bar_px}, {"t", plotly::panel_title_px + 8}};
  return plotly::figure(
      std::move(text), data, layout,
      {.fixed_px = plot_px + plotly::panel_title_px + 70,
       .min_width_px = panels.columns() * cell_px * static_cast<double>(x.ticks.size()) + 150});
}

}  // namespace tofsmith

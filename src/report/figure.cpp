// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "report/figure_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using figure_json::Json;

bool is_id_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

const char* name_of(Dash dash) {
  static constexpr std::array names = {"solid", "dash", "dot", "dash_dot"};
  return names[static_cast<std::size_t>(dash)];
}

const char* name_of(Mark mark) {
  static constexpr std::array names = {"line", "steps", "line_and_markers", "markers"};
  return names[static_cast<std::size_t>(mark)];
}

/// Returns {count, from, to} for many equidistant numbers.
Json places_json(const std::vector<double>& x, const std::optional<double>& period) {
  constexpr std::size_t many = 32;
  const double step = x.size() > 1 ? x[1] - x[0] : 0.0;
  const double last = period && !x.empty() ? x.front() + *period : x.empty() ? 0.0 : x.back();
  const std::size_t count = x.size() + (period && !x.empty() ? 1 : 0);
  bool is_uniform = x.size() >= many && step > 0.0;
  for (std::size_t i = 0; is_uniform && i < count; ++i) {
    const double place = i < x.size() ? x[i] : last;
    is_uniform = std::abs(place - x.front() - step * static_cast<double>(i)) < 1e-6 * (last - x[0]);
  }
  if (is_uniform)
    return {{"count", count},
            {"from", figure_json::number(x.front())},
            {"to", figure_json::number(last)}};
  Json list = figure_json::numbers(x);
  if (count > x.size()) list.push_back(figure_json::number(last));
  return list;
}

Json series_json(const Series& series) {
  const std::string rule = fmt::format("must equal x.size = {}", series.x.size());
  require(series.y.size() == series.x.size(), "Series::y.size", series.y.size(), rule);
  require(series.y_error.empty() || series.y_error.size() == series.x.size(),
          "Series::y_error.size", series.y_error.size(), rule + " or be 0");
  Json json = {{"name", series.name},
               {"x", places_json(series.x, series.period)},
               {"y", figure_json::numbers(series.y)},
               {"mark", name_of(series.mark)},
               {"colour", series.style.colour},
               {"dash", name_of(series.style.dash)},
               {"width", series.style.width_px}};
  if (!series.y_error.empty()) json["error"] = figure_json::numbers(series.y_error);
  if (series.period && !series.x.empty()) json["y"].push_back(json["y"].front());
  return json;
}

Json list_of(const std::vector<Series>& series) {
  Json list = Json::array();
  for (const Series& one : series) list.push_back(series_json(one));
  return list;
}

Json category_axis(const CategoryAxis& axis) {
  return {{"label", axis.label}, {"unit", axis.unit}, {"ticks", axis.ticks}};
}

}  // namespace

LineStyle ColourAssignment::style(const std::string& name) {
  static constexpr std::array palette = {
      "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
  };
  static constexpr std::array dashes = {Dash::solid, Dash::dash, Dash::dot, Dash::dash_dot};
  const int place = order_.try_emplace(name, static_cast<int>(order_.size())).first->second;
  const std::size_t colours = palette.size();
  const auto index = static_cast<std::size_t>(place);
  return {palette[index % colours], dashes[index / colours % dashes.size()]};
}

LineStyle reference_style() { return {"#8a8f98", Dash::dot, 1.5}; }

Figure::Figure(FigureText text, std::string kind, std::string json)
    : text_(std::move(text)), kind_(std::move(kind)), json_(std::move(json)) {
  require(!text_.id.empty() && std::ranges::all_of(text_.id, is_id_character), "FigureText::id",
          text_.id, "must be letters, digits and dashes");
  require(!text_.title.empty(), "FigureText::title", text_.title, "must not be empty");
}

std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return {vector.begin(), vector.end()};
}

Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y) {
  require(!series.empty(), "series.size", series.size(), "must be >= 1");
  return small_multiples(std::move(text), {{"", x, y}}, {{"", {series}}});
}

Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows) {
  require(!columns.empty(), "columns.size", columns.size(), "must be >= 1");
  require(!rows.empty(), "rows.size", rows.size(), "must be >= 1");
  Json json = {{"columns", Json::array()}, {"rows", Json::array()}};
  for (const PanelColumn& column : columns)
    json["columns"].push_back({{"title", column.title},
                               {"x", figure_json::axis(column.x)},
                               {"y", figure_json::axis(column.y)}});
  for (const PanelRow& row : rows) {
    require(row.panels.size() == columns.size(), "PanelRow::panels.size", row.panels.size(),
            fmt::format("must equal columns.size = {}", columns.size()));
    Json panels = Json::array();
    for (const std::vector<Series>& panel : row.panels) panels.push_back(list_of(panel));
    json["rows"].push_back({{"title", row.title}, {"panels", std::move(panels)}});
  }
  return {std::move(text), "lines", json.dump()};
}

Figure heat_map_figure(FigureText text, const std::vector<HeatMap>& maps, const CategoryAxis& x,
                       const CategoryAxis& y, const ColourScale& colours,
                       const HeatMapOptions& options) {
  require(!maps.empty(), "maps.size", maps.size(), "must be >= 1");
  require(options.columns >= 1, "HeatMapOptions::columns", options.columns, "must be >= 1");
  Json json = {{"columns", options.columns},
               {"show_values", options.show_values},
               {"x", category_axis(x)},
               {"y", category_axis(y)},
               {"colours", figure_json::colours(colours)},
               {"panels", Json::array()}};
  for (const HeatMap& map : maps) {
    require(map.values.rows() == std::ssize(y.ticks), "HeatMap::values.rows", map.values.rows(),
            fmt::format("must equal y.ticks.size = {}", y.ticks.size()));
    require(map.values.cols() == std::ssize(x.ticks), "HeatMap::values.cols", map.values.cols(),
            fmt::format("must equal x.ticks.size = {}", x.ticks.size()));
    Json values = Json::array();
    for (Eigen::Index row = 0; row < map.values.rows(); ++row)
      for (const double value : map.values.row(row)) values.push_back(figure_json::number(value));
    json["panels"].push_back({{"title", map.title}, {"values", std::move(values)}});
  }
  return {std::move(text), "map", json.dump()};
}

}  // namespace tofsmith

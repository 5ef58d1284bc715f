// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/error_surface_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "paper/code_styles.hpp"
#include "paper/data_tables.hpp"
#include "paper/surface_figure.hpp"
#include "report/shared/level_text.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

constexpr double slice_ambient_e_per_s = 1e4;

std::vector<std::string> level_texts(const std::vector<double>& levels) {
  std::vector<std::string> texts;
  for (const double level : levels) texts.push_back(level_text(level));
  return texts;
}

CategoryAxis signal_ticks(const ErrorSurface& surface) {
  return {"signal", "e/s", level_texts(surface.signal_e_per_s)};
}
CategoryAxis ambient_ticks(const ErrorSurface& surface) {
  return {"ambient", "e/s", level_texts(surface.ambient_e_per_s)};
}

std::vector<Series> slices(const ErrorSurfaceGroup& group, const std::vector<std::string>& names) {
  std::vector<Series> series;
  for (const std::string& name : names) {
    const ErrorSurface& surface = group.of(name);
    Series line{.name = name,
                .x = surface.signal_e_per_s,
                .mark = Mark::line_and_markers,
                .style = style_of_code(name)};
    for (const double signal : surface.signal_e_per_s) {
      const Estimate error = surface.linear_at({signal, slice_ambient_e_per_s});
      line.y.push_back(1e3 * error.value);
      line.y_error.push_back(2e3 * error.standard_error);
    }
    series.push_back(std::move(line));
  }
  return series;
}

std::string estimate_mm(const Estimate& e) {
  const double uncertainty = 1e3 * e.standard_error;
  return uncertainty < 1.0 ? fmt::format("{:.1f} ± {:.1g}", 1e3 * e.value, uncertainty)
                           : fmt::format("{:.0f} ± {:.0f}", 1e3 * e.value, uncertainty);
}

}  // namespace

const ErrorSurface& ErrorSurfaceGroup::of(const std::string& name) const {
  const auto found = std::ranges::find(surfaces, name, &ErrorSurface::name);
  require(found != surfaces.end(), "surface", name, "must be one of " + title);
  return *found;
}

Figure surfaces_3d(FigureText text, const ErrorSurfaceGroup& group,
                   const std::vector<std::string>& names) {
  std::vector<Surface> surfaces;
  for (const std::string& name : names)
    surfaces.push_back({name, 1e3 * group.of(name).linear_m, style_of_code(name)});
  const ErrorSurface& grid = group.surfaces.front();
  return surface_figure(std::move(text), surfaces, grid.signal_e_per_s, grid.ambient_e_per_s,
                        {Axis{.label = "signal", .unit = "e/s", .logarithmic = true},
                         Axis{.label = "ambient", .unit = "e/s", .logarithmic = true},
                         Axis{.label = "mean depth error", .unit = "mm", .logarithmic = true}});
}

Figure error_heat_maps(FigureText text, const ErrorSurfaceGroup& group,
                       const std::vector<std::string>& names) {
  std::vector<HeatMap> maps;
  for (const std::string& name : names) maps.push_back({name, 1e3 * group.of(name).linear_m});
  const ErrorSurface& grid = group.surfaces.front();
  return heat_map_figure(
      std::move(text), maps, signal_ticks(grid), ambient_ticks(grid),
      {.label = "mean depth error", .unit = "mm", .map = ColourMap::cividis, .logarithmic = true},
      {.columns = 3});
}

Figure ratio_heat_maps(FigureText text, const std::vector<RatioMap>& maps, const ErrorSurface& grid,
                       int columns) {
  std::vector<HeatMap> panels;
  for (const RatioMap& map : maps) panels.push_back({map.title, map.ratio});
  return heat_map_figure(
      std::move(text), panels, signal_ticks(grid), ambient_ticks(grid),
      {.label = "ratio of errors", .map = ColourMap::viridis, .logarithmic = true},
      {.columns = columns});
}

Figure error_by_signal(FigureText text, const std::vector<ErrorSurfaceGroup>& groups,
                       const std::vector<std::string>& names) {
  std::vector<PanelColumn> columns;
  PanelRow row;
  for (const ErrorSurfaceGroup& group : groups) {
    columns.push_back({.title = group.title,
                       .x = {.label = "signal", .unit = "e/s", .logarithmic = true},
                       .y = {.label = "mean depth error", .unit = "mm", .logarithmic = true}});
    row.panels.push_back(slices(group, names));
  }
  return small_multiples(std::move(text), columns, {row});
}

Table geometric_mean_table(const std::string& id, const std::string& caption,
                           const ErrorSurfaceGroup& group) {
  Table table{.id = id,
              .caption = caption,
              .columns = {{"code"}, {"linear (mm)", true}, {"circular (mm)", true}}};
  for (const NamedLevel& level : named_levels())
    table.columns.push_back({fmt::format("{} (mm)", level.name), true});
  double min_error_m = 1e300;
  for (const ErrorSurface& surface : group.surfaces) {
    std::vector<std::string> cells = {surface.name, estimate_mm(surface.linear_geometric_mean_m),
                                      estimate_mm(surface.circular_geometric_mean_m)};
    for (const NamedLevel& level : named_levels())
      cells.push_back(estimate_mm(surface.linear_at(level.point)));
    const bool competes = !surface.name.ends_with("-ideal");
    if (competes && surface.linear_geometric_mean_m.value < min_error_m) {
      min_error_m = surface.linear_geometric_mean_m.value;
      table.highlighted_row = static_cast<int>(table.rows.size());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void add_arrays(NpzArrays& arrays, const std::string& prefix, const ErrorSurfaceGroup& group) {
  const ErrorSurface& grid = group.surfaces.front();
  arrays["signal_e_per_s"] = npy_of(grid.signal_e_per_s);
  arrays["ambient_e_per_s"] = npy_of(grid.ambient_e_per_s);
  const auto add = [&](const char* name, Eigen::MatrixXd ErrorSurface::*values) {
    std::vector<double> all;
    for (const ErrorSurface& surface : group.surfaces)
      for (Eigen::Index row = 0; row < (surface.*values).rows(); ++row)
        for (Eigen::Index column = 0; column < (surface.*values).cols(); ++column)
          all.push_back((surface.*values)(row, column));
    arrays[prefix + name] = NpyArray::of<double>(
        {group.surfaces.size(), grid.ambient_e_per_s.size(), grid.signal_e_per_s.size()}, all);
  };
  add("_linear_mde_m", &ErrorSurface::linear_m);
  add("_linear_se_m", &ErrorSurface::linear_se_m);
  add("_circular_mde_m", &ErrorSurface::circular_m);
  add("_circular_se_m", &ErrorSurface::circular_se_m);
}

std::string surfaces_csv(const std::vector<ErrorSurfaceGroup>& groups) {
  std::string text =
      "setting,code,signal_e_per_s,ambient_e_per_s,linear_mde_m,linear_se_m,circular_mde_m,"
      "circular_se_m,rotation_bin\n";
  for (const ErrorSurfaceGroup& group : groups)
    for (const ErrorSurface& s : group.surfaces)
      for (Eigen::Index column = 0; column < s.linear_m.cols(); ++column)
        for (Eigen::Index row = 0; row < s.linear_m.rows(); ++row)
          text +=
              fmt::format("\"{}\",{},{:.6g},{:.6g},{:.6g},{:.2g},{:.6g},{:.2g},{}\n", group.title,
                          s.name, s.signal_e_per_s[static_cast<std::size_t>(column)],
                          s.ambient_e_per_s[static_cast<std::size_t>(row)], s.linear_m(row, column),
                          s.linear_se_m(row, column), s.circular_m(row, column),
                          s.circular_se_m(row, column), s.rotation_bin);
  return text;
}

}  // namespace tofsmith

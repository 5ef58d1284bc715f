// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "session.hpp"
#include "tofsmith/report/small_multiples.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {

namespace {

constexpr std::size_t most_rows = 1000;
constexpr double wide_ratio = 30.0;  // from here on an axis is logarithmic

bool can_be_drawn(const SweepAxis& axis) {
  return axis.values.size() > 1 && axis.key != "seed" &&
         std::ranges::all_of(axis.values,
                             [](const SettingValue& value) { return value.number.has_value(); });
}

bool is_wide(const SweepAxis& axis) {
  const auto [low, high] =
      std::ranges::minmax(axis.values, {}, [](const SettingValue& value) { return *value.number; });
  return *low.number > 0.0 && *high.number / *low.number >= wide_ratio;
}

/// Errors of one code at one value of an axis, over all values of the others.
struct Group {
  std::vector<Estimate> linear_m, circular_m;
};

/// A letter, digit or dash for each character: the id of a figure.
std::string figure_id(const std::string& key) {
  std::string id = "axis-" + key;
  std::ranges::replace_if(
      id, [](unsigned char c) { return !std::isalnum(c); }, '-');
  return id;
}

Series series_of(const std::string& code, const SweepAxis& axis,
                 const std::map<std::size_t, Group>& groups, std::vector<Estimate> Group::*errors_m,
                 const LineStyle& style) {
  std::size_t whole = 0;
  for (const auto& [index, group] : groups) whole = std::max(whole, group.linear_m.size());
  std::vector<std::pair<double, Estimate>> points;
  for (const auto& [index, group] : groups) {
    Estimate mean = geometric_mean_of(group.*errors_m);
    // A mean over fewer items than elsewhere could not be compared: a gap until they are there.
    if (group.linear_m.size() < whole) mean.value = std::numeric_limits<double>::quiet_NaN();
    points.emplace_back(*axis.values[index].number, mean);
  }
  std::ranges::sort(points, {}, [](const auto& point) { return point.first; });
  Series series{.name = code, .mark = Mark::line_and_markers, .style = style};
  for (const auto& [x, mean] : points) {
    series.x.push_back(x);
    series.y.push_back(1e3 * mean.value);
    series.y_error.push_back(1e3 * mean.standard_error);
  }
  return series;
}

Figure axis_figure(const WorkList& list, std::span<const SweepResult> results, std::size_t a,
                   ColourAssignment& colours) {
  const SweepAxis& axis = list.spec().axes[a];
  std::vector<std::string> codes;
  std::map<std::string, std::map<std::size_t, Group>> groups;
  for (const SweepResult& result : results) {
    const std::string& code = result.error.code;
    if (!groups.contains(code)) codes.push_back(code);
    Group& group = groups[code][list.spec().value_indices(result.item)[a]];
    group.linear_m.push_back(result.error.linear.geometric_mean_m);
    group.circular_m.push_back(result.error.circular.geometric_mean_m);
  }
  const Axis x{.label = axis.key, .logarithmic = is_wide(axis)};
  const auto column = [&](const char* title) {
    return PanelColumn{title, x, {.label = "mean depth error", .unit = "mm", .logarithmic = true}};
  };
  PanelRow row{"", {{}, {}}};
  for (const std::string& code : codes) {
    const LineStyle style = colours.style(code);
    row.panels[0].push_back(series_of(code, axis, groups[code], &Group::linear_m, style));
    row.panels[1].push_back(series_of(code, axis, groups[code], &Group::circular_m, style));
  }
  return small_multiples(
      {.id = figure_id(axis.key),
       .title = "Depth error over " + axis.key,
       .caption = "Geometric mean over operating points and over all values of the other axes, "
                  "with one standard error."},
      {column("linear"), column("circular")}, {row});
}

Table results_table(const WorkList& list, std::span<const SweepResult> results) {
  const SweepSpec& spec = list.spec();
  Table table{.caption = "Geometric means over the operating points of each item."};
  if (results.size() > most_rows)
    table.caption +=
        fmt::format(" The first {} of {} items; --export writes all.", most_rows, results.size());
  table.columns = {{"item", true}, {"code"}};
  for (const SweepAxis& axis : spec.axes)
    if (axis.key != "code") table.columns.push_back({axis.key, true});
  for (const char* header : {"linear (mm)", "circular (mm)", "outliers (%)"})
    table.columns.push_back({header, true});
  for (const SweepResult& result : results.first(std::min(results.size(), most_rows))) {
    std::vector<std::string> row = {fmt::format("{}", result.item + 1), result.error.code};
    const std::vector<std::size_t> indices = spec.value_indices(result.item);
    for (std::size_t a = 0; a < spec.axes.size(); ++a)
      if (spec.axes[a].key != "code") row.push_back(spec.axes[a].values[indices[a]].text);
    double outliers = 0.0;
    for (const PointDepthError& point : result.error.points) outliers += point.outlier_rate.value;
    row.push_back(estimate_mm_text(result.error.linear.geometric_mean_m));
    row.push_back(estimate_mm_text(result.error.circular.geometric_mean_m));
    row.push_back(
        fmt::format("{:.2f}", 100 * outliers / static_cast<double>(result.error.points.size())));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Page sweep_page(const WorkList& list, std::span<const SweepResult> results,
                const SweepCounts& counts, const std::string& command_line) {
  const SweepSpec& spec = list.spec();
  Page page{.title = "Sweep", .subtitle = spec.source_name, .footer = "tofsmith " TOFSMITH_VERSION};
  KeyValueList settings{{{"camera", spec.camera}}};
  for (const std::string& setting : spec.settings) settings.entries.push_back({"set", setting});
  settings.entries.push_back({"trials", fmt::format("{}", spec.options.trials)});
  settings.entries.push_back({"seed", fmt::format("{}", spec.options.seed)});
  settings.entries.push_back({"decoder", std::string(name_of(spec.options.method))});
  for (const SweepAxis& axis : spec.axes)
    settings.entries.push_back(
        {"axis", fmt::format("{}: {} values", axis.key, axis.values.size())});
  page.sections.push_back({"Items",
                           {KeyNumbers{{{"items", fmt::format("{}", list.size())},
                                        {"finished", fmt::format("{}", results.size())},
                                        {"computing time", time_text(counts.seconds)}}},
                            std::move(settings), CodeBlock{command_line}}});
  if (results.empty()) return page;
  ColourAssignment colours;
  Section figures{"Depth error over each axis", {}};
  for (std::size_t a = 0; a < spec.axes.size(); ++a)
    if (can_be_drawn(spec.axes[a]))
      figures.blocks.push_back(axis_figure(list, results, a, colours));
  if (!figures.blocks.empty()) page.sections.push_back(std::move(figures));
  page.sections.push_back({"All items", {results_table(list, results)}});
  return page;
}

}  // namespace tofsmith::apps

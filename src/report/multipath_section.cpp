// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/level_text.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;
using Cells = std::vector<MultipathCell> MultipathMaps::*;

Row row(const MultipathErrorReport& code, const MultipathMaps& maps, const std::string& light,
        const MultipathCell& cell) {
  const bool decoded = std::isfinite(cell.error_m.value);
  return {code.code,
          fmt::format("{:.3g}", maps.signal_e_per_s),
          light,
          mm_text(cell.law_m),
          mm_text(cell.single_bias_m.value),
          mm_text(cell.single_error_m.value),
          mm_text(cell.bias_m.value),
          mm_text(cell.error_m.value),
          decoded ? fmt::format("{:.2f}", cell.gain()) : "",
          mm_text(cell.cramer_rao_mae_m),
          decoded ? fmt::format("{:.1f}", 100 * cell.two_share) : "",
          decoded ? fmt::format("{:.1f}", 100 * cell.unresolved_share) : ""};
}

std::string light_of(const MultipathCell& cell, const char* kind) {
  return fmt::format("{} r = {:.3g}, {:.3g} m", kind, cell.ratio, cell.delay_m);
}

/// Values in order of their first use.
std::vector<double> distinct(const std::vector<MultipathCell>& cells,
                             double MultipathCell::*member) {
  std::vector<double> values;
  for (const MultipathCell& cell : cells)
    if (std::ranges::find(values, cell.*member) == values.end()) values.push_back(cell.*member);
  return values;
}

void add_maps(FigureText text, const std::vector<MultipathErrorReport>& codes, Cells cells,
              const ColourScale& colours, const std::function<double(const MultipathCell&)>& value,
              Section& section) {
  std::vector<HeatMap> maps;
  CategoryAxis x{.label = cells == &MultipathMaps::points ? "delay" : "mean delay", .unit = "m"};
  CategoryAxis y{.label = "ratio"};
  for (const MultipathErrorReport& code : codes)
    for (const MultipathMaps& at : code.maps) {
      const std::vector<double> delays = distinct(at.*cells, &MultipathCell::delay_m);
      const std::vector<double> ratios = distinct(at.*cells, &MultipathCell::ratio);
      HeatMap map{.title = fmt::format("{}, S = {:.3g} e/s", code.code, at.signal_e_per_s)};
      map.values.resize(std::ssize(ratios), std::ssize(delays));
      bool has_value = false;
      for (Eigen::Index r = 0; r < map.values.rows(); ++r)
        for (Eigen::Index d = 0; d < map.values.cols(); ++d) {
          map.values(r, d) =
              value((at.*cells)[static_cast<std::size_t>(r * map.values.cols() + d)]);
          has_value = has_value || std::isfinite(map.values(r, d));
        }
      if (has_value) maps.push_back(std::move(map));
      if (!x.ticks.empty()) continue;
      for (const double d : delays) x.ticks.push_back(fmt::format("{:.3g}", d));
      for (const double r : ratios) y.ticks.push_back(fmt::format("{:.3g}", r));
    }
  if (!maps.empty())
    section.blocks.emplace_back(heat_map_figure(std::move(text), maps, x, y, colours));
}

void add_all_maps(const std::vector<MultipathErrorReport>& codes, Cells cells,
                  const std::string& id, const std::string& light, Section& section) {
  const ColourScale error{.label = "error", .unit = "mm", .logarithmic = true};
  const ColourScale bias{.label = "bias", .unit = "mm", .map = ColourMap::diverging};
  const auto add = [&](const std::string& what, const std::string& caption,
                       const ColourScale& colours, const auto& value) {
    add_maps({.id = "multipath-" + id + "-" + what,
              .title = caption + ", " + light,
              .caption = "Mean over depth."},
             codes, cells, colours, value, section);
  };
  add("single-bias", "Bias of single-path decoding", bias,
      [](const MultipathCell& cell) { return 1e3 * cell.single_bias_m.value; });
  add("bias", "Bias of two-return decoding", bias,
      [](const MultipathCell& cell) { return 1e3 * cell.bias_m.value; });
  add("single-error", "Error of single-path decoding", error,
      [](const MultipathCell& cell) { return 1e3 * cell.single_error_m.value; });
  add("error", "Error of two-return decoding", error,
      [](const MultipathCell& cell) { return 1e3 * cell.error_m.value; });
  add("bound", "Cramer-Rao bound of the direct depth", error,
      [](const MultipathCell& cell) { return 1e3 * cell.cramer_rao_mae_m; });
}

}  // namespace

std::vector<Row> multipath_rows(const std::vector<MultipathErrorReport>& codes) {
  std::vector<Row> rows{{"code", "signal (e/s)", "light", "r d/(1+r) (mm)", "bias 1 (mm)",
                         "error 1 (mm)", "bias 2 (mm)", "error 2 (mm)", "gain", "Cramer-Rao (mm)",
                         "two (%)", "unresolved (%)"}};
  for (const MultipathErrorReport& code : codes)
    for (const MultipathMaps& maps : code.maps) {
      rows.push_back(row(code, maps, "one return", maps.single));
      for (const MultipathCell& cell : maps.points)
        rows.push_back(row(code, maps, light_of(cell, "return"), cell));
      rows.push_back(row(code, maps, "one return, tail decoding", maps.single_by_tail));
      for (const MultipathCell& cell : maps.tails)
        rows.push_back(row(code, maps, light_of(cell, "tail"), cell));
    }
  return rows;
}

Section multipath_section(const std::vector<MultipathErrorReport>& codes) {
  Section section{"Multipath", {}};
  for (const MultipathErrorReport& code : codes)
    if (!code.why_no_two_returns.empty())
      section.blocks.emplace_back(
          Paragraph{code.code + " supports only single-path decoding: " + code.why_no_two_returns});
  add_all_maps(codes, &MultipathMaps::points, "point", "a second return", section);
  add_all_maps(codes, &MultipathMaps::tails, "tail", "an exponential tail", section);
  section.blocks.emplace_back(table_of_rows(
      "multipath",
      "1: single-path decoding, 2: two-return (or tail) decoding; gain: error 1 / error 2.",
      multipath_rows(codes), {0, 2}));
  return section;
}

}  // namespace tofsmith

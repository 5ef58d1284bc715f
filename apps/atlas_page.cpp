// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "atlas_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "session.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {
namespace {

constexpr std::array both_kinds = {DepthErrorKind::linear, DepthErrorKind::circular};

std::set<int> taps_of(const std::vector<AtlasEntry>& entries) {
  std::set<int> taps;
  for (const AtlasEntry& entry : entries) taps.insert(entry.of.taps);
  return taps;
}

struct AtlasAxis {
  std::string id, title, label;
  bool logarithmic;
  double (*of)(const AtlasCamera&);
};

/// Errors for one number of taps over an axis: geometric means over all other cameras. Entries
/// without a position on the axis (e.g. unlimited bandwidth) and means over fewer cameras than the
/// others are omitted.
Series series_of_taps(const std::vector<AtlasEntry>& entries, int taps, DepthErrorKind kind,
                      const AtlasAxis& axis, const LineStyle& style) {
  std::map<double, std::vector<Estimate>> groups;
  for (const AtlasEntry& entry : entries)
    if (entry.of.taps == taps && entry.of.error == kind && axis.of(entry.of) > 0.0)
      groups[axis.of(entry.of)].push_back(entry.error_m());
  std::size_t whole = 0;
  for (const auto& [at, errors_m] : groups) whole = std::max(whole, errors_m.size());
  Series series{.name = fmt::format("{} tap{}", taps, taps == 1 ? "" : "s"),
                .mark = Mark::line_and_markers,
                .style = style};
  for (const auto& [at, errors_m] : groups) {
    if (errors_m.size() < whole) continue;
    const Estimate mean = geometric_mean_of(errors_m);
    series.x.push_back(at);
    series.y.push_back(1e3 * mean.value);
    series.y_error.push_back(1e3 * mean.standard_error);
  }
  return series;
}

Figure atlas_figure(const std::vector<AtlasEntry>& entries, const AtlasAxis& axis,
                    const std::string& caption, ColourAssignment& colours) {
  const Axis x{.label = axis.label, .logarithmic = axis.logarithmic};
  const auto column = [&](DepthErrorKind kind) {
    return PanelColumn{std::string(name_of(kind)),
                       x,
                       {.label = "mean depth error", .unit = "mm", .logarithmic = true}};
  };
  PanelRow row{"", {{}, {}}};
  for (std::size_t k = 0; k < both_kinds.size(); ++k)
    for (const int taps : taps_of(entries))
      row.panels[k].push_back(series_of_taps(entries, taps, both_kinds[k], axis,
                                             colours.style(fmt::format("{}", taps))));
  return small_multiples({.id = axis.id, .title = axis.title, .caption = caption},
                         {column(both_kinds[0]), column(both_kinds[1])}, {row});
}

std::vector<std::string> law_row(int taps, DepthErrorKind kind, std::string exposures,
                                 const AtlasLaw& law) {
  return {fmt::format("{}", taps),
          std::string(name_of(kind)),
          std::move(exposures),
          fmt::format("{:.3g}", 1e3 * law.at_ones_m),
          fmt::format("{:.3f}", law.bandwidth_power),
          fmt::format("{:.3f}", law.peak_power),
          fmt::format("{:.1f}", 100 * law.rms_residual),
          fmt::format("{:.1f}", 100 * law.max_residual),
          fmt::format("{}", law.entries)};
}

Table laws_table(std::vector<std::vector<std::string>> rows, std::string caption) {
  Table table{.caption = std::move(caption)};
  for (std::string& header : rows.front()) table.columns.push_back({std::move(header), true});
  rows.erase(rows.begin());
  table.rows = std::move(rows);
  return table;
}

}  // namespace

std::string bandwidth_text(const AtlasCamera& camera) {
  if (camera.bandwidth_f0 > 0.0) return fmt::format("{:.4g}", camera.bandwidth_f0);
  return fmt::format("pulses {:.4g}", camera.shortest_pulse_periods);
}

std::vector<std::vector<std::string>> law_rows(const std::vector<AtlasEntry>& entries) {
  std::vector<std::vector<std::string>> rows{
      {"taps", "error", "exposures", "at 1 (mm)", "a", "b", "rms (%)", "max (%)", "codes"}};
  for (const int taps : taps_of(entries))
    for (const DepthErrorKind kind : both_kinds) {
      std::map<int, std::vector<AtlasEntry>> by_exposures;
      std::vector<AtlasEntry> of_all;
      for (const AtlasEntry& entry : entries)
        if (entry.of.taps == taps && entry.of.error == kind) {
          by_exposures[entry.of.exposures].push_back(entry);
          of_all.push_back(entry);
        }
      for (const auto& [exposures, of_them] : by_exposures)
        if (const auto law = fit_atlas_law(of_them))
          rows.push_back(law_row(taps, kind, fmt::format("{}", exposures), *law));
      if (by_exposures.size() < 2) continue;
      if (const auto law = fit_atlas_law(best_by_exposures(of_all)))
        rows.push_back(law_row(taps, kind, "best", *law));
    }
  return rows;
}

Page atlas_page(const std::vector<AtlasEntry>& entries, const std::string& command_line) {
  Page page{.title = "Atlas of best codes",
            .subtitle = "15 MHz, 0.3 s, read noise 20 e, the paper's light levels",
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back({"Codes",
                           {KeyNumbers{{{"codes", fmt::format("{}", entries.size())},
                                        {"version", fmt::format("{}", atlas_version)}}},
                            CodeBlock{command_line}}});
  if (entries.empty()) return page;
  const std::vector<AtlasEntry> best = best_by_exposures(entries);
  std::vector<AtlasEntry> limited;
  for (const AtlasEntry& entry : best)
    if (entry.of.bandwidth_f0 > 0.0) limited.push_back(entry);
  ColourAssignment colours;
  Section figures{"Depth error", {}};
  figures.blocks.emplace_back(atlas_figure(
      best,
      {"bandwidth", "Error over bandwidth", "bandwidth of light source and sensor (f0)", true,
       [](const AtlasCamera& of) { return of.bandwidth_f0; }},
      "With the best number of exposures; geometric mean over peak factors.", colours));
  figures.blocks.emplace_back(
      atlas_figure(limited,
                   {"peak", "Error over peak power", "peak factor", true,
                    [](const AtlasCamera& of) { return of.peak_factor; }},
                   "With the best number of exposures; geometric mean over bandwidths.", colours));
  figures.blocks.emplace_back(
      atlas_figure(entries,
                   {"exposures", "Error over exposures", "exposures", false,
                    [](const AtlasCamera& of) { return static_cast<double>(of.exposures); }},
                   "Geometric mean over peak factors and bandwidths.", colours));
  page.sections.push_back(std::move(figures));
  page.sections.push_back({"Laws",
                           {laws_table(law_rows(entries),
                                       "Fitted to cameras with limited bandwidth: error = (at 1) "
                                       "bandwidth^-a peak^-b. The columns rms and max contain "
                                       "residuals of the logarithm of the error.")}});
  return page;
}

}  // namespace tofsmith::apps

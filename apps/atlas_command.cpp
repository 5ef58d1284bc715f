// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {

namespace {

constexpr auto& both_kinds = all_values<DepthErrorKind>;

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

/// Returns a bandwidth such as "10", or the shortest pulse if the bandwidth is unlimited.
std::string bandwidth_text(const AtlasCamera& camera) {
  if (camera.bandwidth_f0 > 0.0) return fmt::format("{:.4g}", camera.bandwidth_f0);
  return fmt::format("pulses {:.4g}", camera.shortest_pulse_periods);
}

/// Returns a heading and a row for each law of taps and error that the entries determine. Uses only
/// the best number of exposures of each camera.
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

/// Returns the atlas as a page: figures of the error over bandwidth, peak factor and exposures for
/// each number of taps, the laws, and a table.
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

struct AtlasArguments {
  std::string file, error, peak, bandwidth, output;
  std::vector<int> taps, exposures;
};

/// Returns true if a value equals "5" or lies in "5:20".
bool lies_in(double value, const std::string& limits, const char* option) {
  std::array<double, 2> range{};
  if (!read_limits(limits, range))
    throw UsageError(
        fmt::format("{}: found {}; expected a number, or a range such as 5:20", option, limits));
  return value >= range[0] && value <= range[1];
}

bool is_listed(int value, const std::vector<int>& values) {
  return values.empty() || std::find(values.begin(), values.end(), value) != values.end();
}

std::vector<AtlasEntry> chosen_entries(const AtlasArguments& arguments) {
  std::vector<AtlasEntry> chosen;
  const std::vector<AtlasEntry> all =
      arguments.file.empty() ? code_atlas() : read_atlas(arguments.file);
  for (const AtlasEntry& entry : all) {
    const AtlasCamera& of = entry.of;
    if (is_listed(of.taps, arguments.taps) && is_listed(of.exposures, arguments.exposures) &&
        (arguments.error.empty() || arguments.error == name_of(of.error)) &&
        (arguments.peak.empty() || lies_in(of.peak_factor, arguments.peak, "--peak")) &&
        (arguments.bandwidth.empty() ||
         lies_in(of.bandwidth_f0, arguments.bandwidth, "--bandwidth")))
      chosen.push_back(entry);
  }
  return chosen;
}

nlohmann::ordered_json atlas_document(const std::vector<AtlasEntry>& entries) {
  nlohmann::ordered_json document = {{"version", atlas_version},
                                     {"codes", nlohmann::ordered_json::array()}};
  for (const AtlasEntry& entry : entries)
    document["codes"].push_back({{"name", entry.code.name()},
                                 {"taps", entry.of.taps},
                                 {"exposures", entry.of.exposures},
                                 {"peak_factor", entry.of.peak_factor},
                                 {"bandwidth_f0", entry.of.bandwidth_f0},
                                 {"shortest_pulse_periods", entry.of.shortest_pulse_periods},
                                 {"error", name_of(entry.of.error)},
                                 {"linear_m", entry.linear_m.value},
                                 {"linear_se_m", entry.linear_m.standard_error},
                                 {"circular_m", entry.circular_m.value},
                                 {"circular_se_m", entry.circular_m.standard_error}});
  return document;
}

std::string csv_of(const std::vector<AtlasEntry>& entries) {
  const nlohmann::ordered_json document = atlas_document(entries);
  std::string text;
  for (const auto& code : document["codes"]) {
    std::vector<std::string> names, values;
    for (const auto& [name, value] : code.items()) {
      names.push_back(name);
      values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    if (text.empty()) text = fmt::format("{}\n", fmt::join(names, ","));
    text += fmt::format("{}\n", fmt::join(values, ","));
  }
  return text;
}

void print_entries(const Session& session, const std::vector<AtlasEntry>& entries,
                   const AtlasArguments& arguments) {
  session.print_json(atlas_document(entries));
  // To limit the list, show only the best number of exposures for each camera, unless exposures are
  // given.
  const std::vector<AtlasEntry> shown =
      arguments.exposures.empty() ? best_by_exposures(entries) : entries;
  std::vector<std::vector<std::string>> rows{
      {"code", "taps", "exposures", "peak", "bandwidth (f0)", "linear (mm)", "circular (mm)"}};
  for (const AtlasEntry& entry : shown)
    rows.push_back({entry.code.name(), fmt::format("{}", entry.of.taps),
                    fmt::format("{}", entry.of.exposures),
                    fmt::format("{:.4g}", entry.of.peak_factor), bandwidth_text(entry.of),
                    estimate_mm_text(entry.linear_m), estimate_mm_text(entry.circular_m)});
  session.say(text_table(rows));
  session.say(
      fmt::format("{} of {} codes, each the best found for its camera (15 MHz, 0.3 s, read "
                  "noise 20 e, the paper's light levels){}",
                  shown.size(), code_atlas().size(),
                  arguments.exposures.empty() ? ", with the best number of exposures" : ""));
  if (const auto laws = law_rows(entries); laws.size() > 1)
    session.say(
        "error = (at 1) bandwidth^-a peak^-b, fitted to the cameras with limited bandwidth:\n" +
        text_table(laws));
}

void run_atlas(const AtlasArguments& arguments, const Session& session) {
  const std::filesystem::path output(arguments.output);
  if (!arguments.output.empty()) {
    if (const auto kind = output.extension(); kind != ".csv" && kind != ".html")
      throw UsageError(
          fmt::format("-o {}: unknown extension; expected .csv or .html", arguments.output));
    session.check_output(output);
  }
  const std::vector<AtlasEntry> entries = chosen_entries(arguments);
  if (entries.empty())
    throw UsageError(
        "found no code for these taps, exposures, peak factors, bandwidths and errors; `tofsmith "
        "atlas` lists the available ones");
  if (!arguments.output.empty())
    write_file_atomically(output,
                          output.extension() == ".csv"
                              ? csv_of(entries)
                              : render(atlas_page(entries, session.command_line)),
                          session.output_policy());
  print_entries(session, entries, arguments);
  if (!arguments.output.empty()) session.say("wrote " + arguments.output);
}

}  // namespace

void add_atlas_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<AtlasArguments>();
  CLI::App* command = app.add_subcommand(
      "atlas", "browse precomputed best codes by bandwidth, peak factor, taps and exposures");
  command->add_option("--taps", arguments->taps, "numbers of taps, such as 1,2 (default: all)")
      ->delimiter(',');
  command
      ->add_option("--exposures", arguments->exposures,
                   "numbers of exposures, such as 3,4 (default: only the best number for each "
                   "camera)")
      ->delimiter(',');
  command->add_option("--peak", arguments->peak, "peak factor, or a range from:to");
  command->add_option(
      "--bandwidth", arguments->bandwidth,
      "bandwidth of light source and sensor in multiples of the fundamental frequency, or a "
      "range from:to; 0: unlimited");
  command
      ->add_option("--error", arguments->error, "kind of depth error for which codes were designed")
      ->check(one_of<DepthErrorKind>());
  command->add_option("--file", arguments->file,
                      "atlas file, as written by scripts/atlas.sh (default: the built-in atlas)");
  command->add_option("-o,--output", arguments->output,
                      "write a table (.csv) or a page with figures (.html)");
  command->callback([arguments, &session] { run_atlas(*arguments, session); });
}

}  // namespace tofsmith::apps

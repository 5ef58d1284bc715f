// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "atlas_page.hpp"
#include "commands.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::apps {
namespace {

struct AtlasArguments {
  std::string file, error, peak, bandwidth, output;
  std::vector<int> taps, exposures;
};

/// Returns true if a value equals "5" or lies in "5:20".
bool lies_in(double value, const std::string& limits, const char* option) {
  double low = 0.0, high = 0.0;
  if (limits.find(':') == std::string::npos) {
    if (!CLI::detail::lexical_cast(limits, low))
      throw UsageError(
          fmt::format("{}: found {}; expected a number, or a range such as 5:20", option, limits));
    high = low;
  } else if (!read_number_pair(limits, ':', low, high)) {
    throw UsageError(
        fmt::format("{}: found {}; expected a number, or a range such as 5:20", option, limits));
  }
  return value >= low && value <= high;
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
      ->check(one_of({"linear", "circular"}));
  command->add_option("--file", arguments->file,
                      "atlas file, as written by scripts/atlas.sh (default: the built-in atlas)");
  command->add_option("-o,--output", arguments->output,
                      "write a table (.csv) or a page with figures (.html)");
  command->callback([arguments, &session] { run_atlas(*arguments, session); });
}

}  // namespace tofsmith::apps

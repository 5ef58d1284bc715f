// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "table_arguments.hpp"
#include "one_of.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "number_checks.hpp"
#include "played_code.hpp"
#include "session.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith::apps {

namespace {

/// Ambient light that is taken to be equal, though the columns look as if duties were not.
std::optional<std::string> duty_note(const std::string& path, const MeasuredTable& measured) {
  constexpr double usual_spread = 0.02;
  const Eigen::VectorXd mean = ambient_gain_of(measured.correlation, MeasuredAmbient::mean);
  const double spread = mean.maxCoeff() - mean.minCoeff();
  if (spread <= usual_spread * measured.correlation.cwiseAbs().maxCoeff()) return std::nullopt;
  return fmt::format(
      "{}: ambient light was taken to add the same to every measurement, but the "
      "means of the columns differ; --ambient mean or none, or an array 'ambient', "
      "says otherwise (or a dark offset was not subtracted: an array 'offset_dn' says "
      "what raw numbers are without light)",
      path);
}

}  // namespace

void TableArguments::add_to(CLI::App& command) {
  command
      .add_option("--range-m", range_m_,
                  "depth of the period of a measured table in metres (the camera's)")
      ->check(positive_number(1e6));
  command
      .add_option("--ambient", ambient_,
                  "what constant light adds to the columns of a measured table: as much to each "
                  "(unless the file says), as much as their mean, or nothing")
      ->check(one_of({"equal", "mean", "none"}));
  command
      .add_option("--table-axes", axes_,
                  "axes of a measured table: samples by measurements (nk), or the other way (kn)")
      ->check(one_of({"nk", "kn"}));
  command.add_flag("--keep-end-point", keep_end_point_,
                   "keep a measured table's last sample though it equals the first");
}

std::string DecodingSource::range_line() const {
  return fmt::format("range {:.4g} m ({})", table.range_m, range_source);
}

DecodingSource TableArguments::load(const std::string& code, const Camera& camera,
                                    bool default_camera, const TapArguments& taps) const {
  DecodingSource source;
  const bool is_table = names_measured_table(code);
  if (is_table) {
    source = load_measured(code, camera, taps);
  } else {
    const char* const of_tables = range_m_            ? "--range-m"
                                  : !ambient_.empty() ? "--ambient"
                                  : !axes_.empty()    ? "--table-axes"
                                  : keep_end_point_   ? "--keep-end-point"
                                                      : nullptr;
    const CodeSet played = load_played_code(code, camera, taps);
    if (of_tables)
      throw UsageError(
          fmt::format("{} goes with a measured table; {} is a code, which the camera "
                      "says all of",
                      of_tables, code));
    source.name = played.name();
    source.table = make_decoding_table(ForwardModel(played, camera), camera);
  }
  if (range_m_)
    source.range_source = "--range-m";
  else if (default_camera)
    source.range_source =
        fmt::format("of the default camera {}; {}", camera.name,
                    is_table ? "--range-m or --camera say otherwise" : "--camera says otherwise");
  else
    source.range_source = fmt::format("of the camera {}", camera.name);
  source.tell_range = is_table || default_camera;
  if (const auto note = ambiguity_note(source.table)) source.notes.push_back(*note);
  return source;
}

DecodingSource TableArguments::load_measured(const std::string& path, const Camera& camera,
                                             const TapArguments& taps) const {
  MeasuredTableOptions options;
  options.layout = {taps.taps.value_or(camera.sensor.taps), taps.tap_order()};
  if (!axes_.empty()) options.axes = parse_table_axes(axes_);
  options.keep_end_point = keep_end_point_;
  auto [measured, notes] = read_measured_table(path, options);
  if (!ambient_.empty())
    measured.ambient_gain = ambient_gain_of(measured.correlation, parse_measured_ambient(ambient_));
  else if (measured.ambient_gain.size() == 0 && camera.sensor.readout == Readout::separate)
    if (const auto note = duty_note(path, measured)) notes.push_back(*note);
  try {
    DecodingSource source;
    source.name = std::filesystem::path(path).stem().string();
    source.table = make_decoding_table(measured, camera);
    source.notes = std::move(notes);
    if (range_m_) source.table.range_m = *range_m_;
    source.table.validate();
    return source;
  } catch (const std::invalid_argument& error) {
    throw IoError(path, error.what());
  }
}

std::optional<std::string> ambiguity_note(const DecodingTable& table) {
  constexpr std::size_t most_shown = 3;
  std::vector<AmbiguousDepths> pairs = ambiguous_depths(table);
  if (pairs.empty()) return std::nullopt;
  const auto distance_bin = [&](const AmbiguousDepths& pair) {
    return std::abs(circular_difference(pair.first_bin, pair.second_bin, table.samples()));
  };
  std::ranges::stable_sort(pairs, std::ranges::greater(), distance_bin);
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(pairs.size(), most_shown); ++i)
    shown.push_back(fmt::format("{:.4g} m as {:.4g} m", pairs[i].second_m, pairs[i].first_m));
  return fmt::format("{} of {} bins look like a nearer one and decode to it: {}{}", pairs.size(),
                     table.samples(), fmt::join(shown, ", "),
                     pairs.size() > most_shown ? ", .." : "");
}

}  // namespace tofsmith::apps

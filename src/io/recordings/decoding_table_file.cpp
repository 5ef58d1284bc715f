// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/decoding_table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <system_error>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

/// Returns a note if ambient light is assumed equal although the duties of the columns differ.
std::optional<std::string> duty_note(const std::string& path, const MeasuredTable& measured) {
  constexpr double usual_spread = 0.02;
  const Eigen::VectorXd mean = ambient_gain_of(measured.correlation, MeasuredAmbient::mean);
  const double spread = mean.maxCoeff() - mean.minCoeff();
  if (spread <= usual_spread * measured.correlation.cwiseAbs().maxCoeff()) return std::nullopt;
  return fmt::format(
      "{}: ambient light was assumed equal in all measurements, but the means of the columns "
      "differ; if ambient light is not equal, use --ambient mean or none, or an array 'ambient'; "
      "if a dark offset was not subtracted, add it as an array 'offset_dn'",
      path);
}

void refuse_table_options(const std::string& code, const DecodingTableOptions& options) {
  const char* const field = options.range_m          ? "range_m"
                            : options.ambient        ? "ambient"
                            : options.axes           ? "axes"
                            : options.keep_end_point ? "keep_end_point"
                                                     : nullptr;
  require(
      !field, "code", code,
      fmt::format("must be a measured table for {}; for a code, the camera determines this value",
                  field ? field : ""));
}

void apply(const DecodingTableOptions& options, MeasuredTable& measured) {
  if (!options.order.empty()) {
    const int side = measured.taps, exposures = measured.columns() / side;
    Playback{.order = options.order}.validate(side);
    require(static_cast<int>(options.order.size()) == exposures, "order",
            fmt::format("{} entries", options.order.size()),
            fmt::format("must have one for each of the {} exposures", exposures));
    Eigen::VectorXi source(measured.columns());
    for (int i = 0; i < measured.columns(); ++i)
      source[i] = options.order[static_cast<std::size_t>(i / side)] * side + i % side;
    measured = measured.in_order(source);
  }
  if (!options.reversed) return;
  const Eigen::Index rest = measured.correlation.rows() - 1;
  measured.correlation.bottomRows(rest) =
      measured.correlation.bottomRows(rest).colwise().reverse().eval();
}

LoadedDecodingTable load_measured(const std::string& path, const Camera& camera,
                                  const DecodingTableOptions& options) {
  auto [measured, notes] = read_measured_table(
      path, {.layout = {options.file.taps.value_or(camera.sensor.taps), options.file.tap_order},
             .axes = options.axes,
             .keep_end_point = options.keep_end_point});
  apply(options, measured);
  measured.range_m = options.range_m;
  if (options.ambient)
    measured.ambient_gain = ambient_gain_of(measured.correlation, *options.ambient);
  else if (measured.ambient_gain.size() == 0 && camera.sensor.readout == Readout::separate &&
           !camera.sensor.is_signed())
    if (const auto note = duty_note(path, measured)) notes.push_back(*note);
  try {
    LoadedDecodingTable loaded{.name = std::filesystem::path(path).stem().string(),
                               .table = make_decoding_table(measured, camera),
                               .is_measured = true,
                               .notes = std::move(notes)};
    loaded.table.validate();
    return loaded;
  } catch (const std::invalid_argument& error) {
    throw IoError(path, error.what());
  }
}

/// Returns a note if rows are too far apart for interpolation.
std::optional<std::string> coarse_note(const DecodingTable& table, bool is_measured) {
  constexpr double fine_deg = 10.0;
  const double turn_deg = furthest_turn_rad(table) * 180.0 / std::numbers::pi;
  if (!(turn_deg > fine_deg)) return std::nullopt;
  const double times = std::ceil(turn_deg / fine_deg);
  return fmt::format(
      "{} rows are few for this table: it rotates by up to {:.0f} degrees from row to row, and "
      "depths between rows are interpolated linearly; {}{:.0f}{}",
      table.samples(), turn_deg,
      is_measured ? "measure it at " : "use --set samples=", times * table.samples(),
      is_measured ? " delays" : "");
}

Camera with_playback(Camera camera, const DecodingTableOptions& options) {
  if (options.order.empty() && !options.reversed) return camera;
  Playback playback = camera.playback.value_or(Playback());
  if (!options.order.empty()) playback.order = options.order;
  if (options.reversed) playback.reversed = !playback.reversed;
  camera.playback = playback;
  return camera;
}

}  // namespace

std::optional<std::string> ambiguity_note(const DecodingTable& table) {
  constexpr std::size_t max_shown = 3;
  std::vector<AmbiguousDepths> pairs = ambiguous_depths(table);
  if (pairs.empty()) return std::nullopt;
  const auto distance_bin = [&](const AmbiguousDepths& pair) {
    return std::abs(circular_difference(pair.first_bin, pair.second_bin, table.bin_count()));
  };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const auto& a, const auto& b) { return distance_bin(a) > distance_bin(b); });
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(pairs.size(), max_shown); ++i)
    shown.push_back(fmt::format("{:.4g} m as {:.4g} m", pairs[i].second_m, pairs[i].first_m));
  return fmt::format("{} of {} bins are ambiguous and decode to a nearer bin: {}{}", pairs.size(),
                     table.bin_count(), fmt::join(shown, ", "),
                     pairs.size() > max_shown ? ", ..." : "");
}

bool names_measured_table(const std::string& code) {
  std::error_code ignored;
  return !is_family(code) && std::filesystem::is_regular_file(code, ignored) &&
         is_measured_table(code);
}

void require_no_measured_table(const std::string& code) {
  if (names_measured_table(code))
    throw IoError(
        code,
        "found no modulation and demodulation functions, as in a measured table, which only decode "
        "supports; expected .json, .npz with modfs and demodfs, or .csv with columns modulation_1, "
        "... and demodulation_1, ...");
}

CodeSet load_camera_code(const std::string& code, const Camera& camera,
                         const CodeFileOptions& options) {
  require_no_measured_table(code);
  CodeSet actual = load_code(code, camera, options);
  return actual.samples() == camera.samples ? actual : actual.resampled(camera.samples);
}

LoadedDecodingTable load_decoding_table(const std::string& code, const Camera& camera,
                                        const DecodingTableOptions& options) {
  check_fields(options);
  check_fields(options.file);
  LoadedDecodingTable loaded;
  if (names_measured_table(code)) {
    loaded = load_measured(code, camera, options);
  } else {
    const CodeSet actual = load_camera_code(code, camera, options.file);
    refuse_table_options(code, options);
    loaded.name = actual.name();
    const Camera playing = with_playback(camera, options);
    loaded.table = make_decoding_table(ForwardModel(actual, playing), playing);
  }
  if (const auto note = ambiguity_note(loaded.table)) loaded.notes.push_back(*note);
  if (const auto note = coarse_note(loaded.table, names_measured_table(code)))
    loaded.notes.push_back(*note);
  return loaded;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/design_sections.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// 0 if unknown (measured responses).
double cutoff_hz(const Camera& camera) {
  double least_hz = infinity;
  for (const ImpulseResponse* response :
       {&camera.light.impulse_response, &camera.sensor.impulse_response})
    for (const double cutoff_hz : {response->f_max_hz, response->cutoff_hz})
      if (cutoff_hz > 0.0) least_hz = std::min(least_hz, cutoff_hz);
  return std::isfinite(least_hz) ? least_hz : 0.0;
}

/// Empty if only the factor is known.
std::string amount_text(const Camera& camera, CameraQuantity quantity) {
  switch (quantity) {
    case CameraQuantity::bandwidth:
      return cutoff_hz(camera) > 0.0 ? plain_number(cutoff_hz(camera) / 1e6, 4) + " MHz" : "";
    case CameraQuantity::power:
      return camera.optics ? plain_number(camera.optics->source_power_w, 4) + " W" : "";
    case CameraQuantity::exposure:
      return plain_number(1e3 * camera.exposure_s.sum_s(), 4) + " ms";
  }
  return "";
}

/// "2.3 x = 345 MHz".
std::string scaled_text(const Camera& camera, CameraQuantity quantity, double factor) {
  const std::string amount = amount_text(with_scaled(camera, quantity, factor), quantity);
  const std::string times = plain_number(factor, 3) + " x";
  return amount.empty() ? times : fmt::format("{} = {}", times, amount);
}

Figure error_map(const RequirementMap& map, double error_m) {
  HeatMap values{.title = "", .values = 1e3 * map.error_m};
  CategoryAxis x{.label = "power", .unit = "times the camera's"};
  CategoryAxis y{.label = "bandwidth", .unit = "times the camera's"};
  for (const double factor : map.power) x.ticks.push_back(plain_number(factor, 2));
  for (const double factor : map.bandwidth) y.ticks.push_back(plain_number(factor, 2));
  return heat_map_figure(
      {.id = "error-map",
       .title = "Depth error over bandwidth and power",
       .caption = fmt::format(
           "Smallest error of the codes found. The codes were found for each bandwidth at "
           "the power of the camera. Errors of at most {} suffice.",
           length_text(error_m))},
      {values}, x, y, {.label = "depth error", .unit = "mm", .logarithmic = true});
}

/// "from 1 to 3 m", or "anywhere in the range of 10 m".
std::string distance_text(const Camera& camera) {
  const std::string depths = true_depths_in_words(camera);
  return camera.operating.working_distance_m
             ? depths
             : fmt::format("{} of {} m", depths, plain_number(camera.range_m(), 4));
}

std::string levels_text(const std::vector<double>& levels) {
  const auto [low, high] = std::ranges::minmax(levels);
  if (levels.size() == 1) return level_text(low) + " e/s";
  return fmt::format("{} to {} e/s ({} levels)", level_text(low), level_text(high), levels.size());
}

std::string white_distance_text(const Camera& camera) {
  const auto [low, high] = std::ranges::minmax(camera.operating.signal_e_per_s);
  const auto metres = [&](double signal) {
    return plain_number(camera.optics->distance_m(signal), 3) + " m";
  };
  return low == high ? metres(low) : metres(high) + " to " + metres(low);
}

std::string sunlight_text(const Optics& optics) {
  if (optics.sunlight_klux) return plain_number(*optics.sunlight_klux, 4) + " klx";
  if (optics.sunlight_w_per_m2_nm)
    return plain_number(*optics.sunlight_w_per_m2_nm, 4) + " W/(m2 nm)";
  return "none";
}

KeyValueList conditions(const Camera& camera, const Requirements& found,
                        const RequirementOptions& options) {
  KeyValueList list{{{"depth error to reach", length_text(options.error_m)},
                     {"depth error of the current camera",
                      fmt::format("{} with {}", length_text(found.error_m), found.code.name())},
                     {"true depths", distance_text(camera)},
                     {"signal", levels_text(camera.operating.signal_e_per_s)},
                     {"ambient light", levels_text(camera.operating.ambient_e_per_s)},
                     {"codes", searched_codes_text(options)}}};
  if (camera.optics) {
    list.entries.push_back({"distance of a white surface", white_distance_text(camera)});
    list.entries.push_back({"sunlight", sunlight_text(*camera.optics)});
  }
  return list;
}

}  // namespace

std::string searched_codes_text(const RequirementOptions& options) {
  if (options.exact)
    return fmt::format("codes designed with effort {}", plain_number(options.effort, 3));
  return "atlas codes, although designed codes may require less (option exact)";
}

std::vector<std::vector<std::string>> requirement_rows(const Camera& camera,
                                                       const Requirements& found,
                                                       const RequirementOptions& options) {
  std::vector<std::vector<std::string>> rows{
      {"vary", "now", "suffices", "error (mm)", "code", "no code below"}};
  for (const Sufficiency& s : found.varied) {
    const std::string now = amount_text(camera, s.quantity);
    rows.push_back({std::string(name_of(s.quantity)), now.empty() ? "1 x" : now,
                    s.factor
                        ? scaled_text(camera, s.quantity, *s.factor)
                        : fmt::format("not reached at {} x", plain_number(options.max_factor, 3)),
                    plain_number(1e3 * s.error_m, 4), s.code.name(),
                    s.excluded_below == 0.0 ? "(no bound)"
                    : s.excluded_below >= options.max_factor
                        ? fmt::format("at least {} x", plain_number(options.max_factor, 3))
                        : scaled_text(camera, s.quantity, s.excluded_below)});
  }
  return rows;
}

Page requirements_report(const Camera& camera, const Requirements& found,
                         const RequirementOptions& options, const std::string& command_line) {
  Page page{
      .title = fmt::format("Requirements for {} on {}", length_text(options.error_m), camera.name),
      .subtitle = fmt::format(
          "The camera currently reaches {} with {}{}", length_text(found.error_m),
          found.code.name(),
          camera.optics ? fmt::format("; white surface at {}, sunlight {}",
                                      white_distance_text(camera), sunlight_text(*camera.optics))
                        : ""),
      .footer = "tofsmith " TOFSMITH_VERSION};
  Table table =
      table_of_rows("requirements",
                    "Smallest sufficient amount of each quantity, with the others unchanged. Below "
                    "the amount in the last column, no code reaches the error (receiver bound).",
                    requirement_rows(camera, found, options), {0, 1, 2, 4, 5});
  page.sections.push_back(
      {"Sufficient amounts", {conditions(camera, found, options), std::move(table)}});
  if (found.map)
    page.sections.push_back({"Bandwidth and power", {error_map(*found.map, options.error_m)}});
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith

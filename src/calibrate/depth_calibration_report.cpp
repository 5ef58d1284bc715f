// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/calibration_page.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

/// Correction in the middle of the image, without the mean error [mm].
std::vector<Series> correction_curves(const CalibratedDepth& found) {
  ColourAssignment colours;
  Series known{.name = "correction", .style = colours.style("correction")};
  Series beyond{.name = "correction, extrapolated", .style = colours.style("correction")};
  beyond.style.dash = Dash::dash;
  const DepthCorrection& correction = *found.table.correction;
  const std::vector<double>& depths = found.picture.depth_m;
  const double range_m = 2.0 * depths.front() * static_cast<double>(depths.size());
  for (const double depth_m : depths) {
    const double error_m = correction.error_m(depth_m, range_m, correction.height / 2,
                                              correction.width / 2, correction.signal_e_per_s);
    const double off_m = std::remainder(error_m - found.mean_error_m, range_m);
    const auto part = static_cast<Eigen::Index>(depth_m / range_m *
                                                static_cast<double>(correction.known_share.size()));
    const bool is_known = correction.known_share[part] > 0.5;
    for (auto [series, counts] : {std::pair{&known, is_known}, {&beyond, !is_known}}) {
      series->x.push_back(depth_m);
      series->y.push_back(counts ? 1e3 * off_m : std::nan(""));
    }
  }
  std::vector<Series> curves{std::move(known)};
  if (found.known_share < 0.999) curves.push_back(std::move(beyond));
  return curves;
}

Figure error_figure(const CalibratedDepth& found) {
  ColourAssignment colours;
  const auto points = [&](const std::string& name, const std::vector<double>& errors_m) {
    Series series{.name = name, .mark = Mark::markers, .style = colours.style(name)};
    for (std::size_t p = 0; p < errors_m.size(); ++p) {
      if (!std::isfinite(errors_m[p])) continue;
      series.x.push_back(found.picture.depth_m[p]);
      series.y.push_back(1e3 * errors_m[p]);
    }
    return series;
  };
  std::vector<Series> series = correction_curves(found);
  for (const Series& curve : series) colours.style(curve.name);
  series.push_back(points("error", found.picture.before_m));
  series.push_back(points("remaining error", found.picture.after_m));
  return line_figure(
      {.id = "error-over-depth",
       .title = "Depth error over depth",
       .caption = "Depth error minus its mean over all pixels. Curve: correction in the "
                  "middle of the image at the usual signal. Points: means over the image."},
      series, {.label = "decoded depth", .unit = "m"}, {.label = "depth error", .unit = "mm"});
}

Figure drift_figure(const FigureText& text, const TemperatureDrift& found,
                    const std::vector<double>& of_frames, const Estimate& per_c, double scale,
                    const Axis& axis) {
  ColourAssignment colours;
  Series frames{.name = "frames", .mark = Mark::markers, .style = colours.style("frames")};
  Series line{.name = "line", .style = reference_style()};
  for (std::size_t f = 0; f < of_frames.size(); ++f) {
    frames.x.push_back(found.temperature_c[f]);
    frames.y.push_back(scale * of_frames[f]);
  }
  const auto [coldest, warmest] = std::ranges::minmax(found.temperature_c);
  for (const double t : {coldest, warmest}) {
    line.x.push_back(t);
    line.y.push_back(scale * per_c.value * (t - found.mean_c));
  }
  return line_figure(text, {frames, line}, {.label = "temperature", .unit = "degrees C"}, axis);
}

}  // namespace

std::vector<std::vector<std::string>> depth_term_rows(const CalibratedDepth& found) {
  constexpr double apart_m = 20e-3;
  std::vector<std::vector<std::string>> rows{{"term", "value (mm)", "95 % (mm)"}};
  int mingled = 0;
  for (const CalibratedTerm& term : found.terms) {
    if (term.value_m.standard_error > apart_m && ++mingled) continue;
    rows.push_back({term.name, fmt::format("{:.3f}", 1e3 * term.value_m.value),
                    fmt::format("± {:.3f}", 1.96e3 * term.value_m.standard_error)});
  }
  if (mingled > 0)
    rows.push_back(
        {fmt::format("{} more, which this part of the range cannot separate", mingled), "", ""});
  return rows;
}

std::vector<std::vector<std::string>> frequency_rows(const CalibratedDepth& found) {
  if (found.frequencies.empty()) return {};
  std::vector<std::vector<std::string>> rows{{"frequency (MHz)", "offset (mm)", "95 % (mm)",
                                              "contrast", "95 %",
                                              "harmonics (% of the fundamental)"}};
  for (const CalibratedFrequency& its : found.frequencies) {
    std::string harmonics;
    for (const CalibratedHarmonic& h : its.harmonics) {
      const double share = std::hypot(h.in_phase.value, h.quadrature.value);
      const double error = std::hypot(h.in_phase.standard_error, h.quadrature.standard_error);
      if (share > 3.0 * error)
        harmonics +=
            fmt::format("{}{}: {:.2f}", harmonics.empty() ? "" : ", ", h.harmonic, 100.0 * share);
    }
    rows.push_back({fmt::format("{:.6g}", 1e-6 * its.frequency_hz),
                    fmt::format("{:.3f}", 1e3 * its.offset_m.value),
                    fmt::format("± {:.3f}", 1.96e3 * its.offset_m.standard_error),
                    fmt::format("{:.4f}", its.contrast.value),
                    fmt::format("± {:.4f}", 1.96 * its.contrast.standard_error),
                    harmonics.empty() ? "none" : harmonics});
  }
  return rows;
}

std::string depth_error_text(const CalibratedDepth& found) {
  return fmt::format("mean offset {:+.4g} m, residual {} rms; {}", found.mean_error_m,
                     length_text(found.rms_before_m),
                     found.rms_m
                         ? length_text(*found.rms_m) + " rms on held-out blocks after correction"
                         : "remaining error unknown");
}

Page depth_report(const CalibratedDepth& found, const std::string& source,
                  const std::string& command_line) {
  Page page{.title = fmt::format("Depth of {} against a reference", source),
            .subtitle = depth_error_text(found)};
  const auto image = [&](const std::string& id, const std::string& title,
                         const std::string& caption) {
    return image_figure(
        {.id = id, .title = title, .caption = caption},
        {{"before", found.picture.before_image_m}, {"corrected", found.picture.after_image_m}},
        {.label = "depth error", .unit = "m", .map = ColourMap::diverging, .clip_fraction = 0.02});
  };
  if (!found.frequencies.empty())
    page.sections.push_back({"Frequencies",
                             {table_of_rows("frequencies",
                                            "Depth offset, contrast relative to the camera's "
                                            "model, and additional harmonics of each frequency.",
                                            frequency_rows(found), {5})}});
  page.sections.push_back(
      {"Over depth",
       {error_figure(found),
        table_of_rows("terms",
                      "Terms of the error in the covered part of the range, with 95 % intervals.",
                      depth_term_rows(found), {0})}});
  page.sections.push_back(
      {"Over the image",
       {image("error-image", "Depth error",
              "Mean over all frames, minus the mean over all pixels. Pixels that do not fit the "
              "model are empty.")}});
  return finished_calibration_page(std::move(page), found.notes, command_line);
}

Page temperature_report(const TemperatureDrift& found, const std::string& source,
                        const std::string& command_line) {
  const auto row = [&](const char* key, const Estimate& e, double scale, const char* unit) {
    return std::vector<std::string>{
        key, fmt::format("{:+.4f}", scale * e.value),
        fmt::format("± {:.4f}", scale * found.interval_factor * e.standard_error), unit};
  };
  Table table{
      .caption = fmt::format("Change per degree, with 95 % intervals, of {} pixels.", found.pixels),
      .columns = {{"key"}, {"per degree", true}, {"95 %", true}, {"unit"}},
      .rows = {row("temperature.offset_m_per_c", found.offset_m_per_c, 1e3, "mm"),
               row("temperature.signal_per_c", found.signal_per_c, 1e2, "%")}};
  if (found.sensor) {
    const SensorDrift& sensor = *found.sensor;
    table.rows.push_back(
        row("temperature.sensor.offset_m_per_c", sensor.offset_m_per_c, 1e3, "mm"));
    table.rows.push_back(row("temperature.sensor.signal_per_c", sensor.signal_per_c, 1e2, "%"));
  }
  Section section{"Drift", {std::move(table)}};
  section.blocks.push_back(drift_figure(
      {.id = "depth-over-temperature",
       .title = "Depth",
       .caption = "Difference between each frame and the mean of all frames; median over pixels."},
      found, found.offset_m, found.offset_m_per_c, 1e3, {.label = "depth change", .unit = "mm"}));
  section.blocks.push_back(drift_figure(
      {.id = "signal-over-temperature",
       .title = "Signal",
       .caption =
           "Logarithm of the signal: difference between each frame and the mean of all frames; "
           "median over pixels."},
      found, found.log_signal, found.signal_per_c, 1e2, {.label = "signal change", .unit = "%"}));
  return finished_calibration_page({.title = fmt::format("Drift with temperature of {}", source),
                                    .subtitle = fmt::format("{} frames around {:.1f} degrees C",
                                                            found.offset_m.size(), found.mean_c),
                                    .sections = {std::move(section)}},
                                   found.notes, command_line);
}

Page stray_light_report(const CalibratedStrayLight& found, const std::string& source,
                        const std::string& command_line) {
  ColourAssignment colours;
  Series shares{.name = "share", .mark = Mark::line_and_markers, .style = colours.style("share")};
  Table table{.caption =
                  "Share of a pixel's light that each pixel at this distance receives, with 95 % "
                  "intervals.",
              .columns = {{"distance (px)", true}, {"share (ppm)", true}, {"95 % (ppm)", true}}};
  for (std::size_t j = 0; j < found.share.size(); ++j) {
    shares.x.push_back(found.radius_px[j]);
    shares.y.push_back(1e6 * found.share[j].value);
    shares.y_error.push_back(1.96e6 * found.share[j].standard_error);
    table.rows.push_back({fmt::format("{:.1f}", found.radius_px[j]),
                          fmt::format("{:.3f}", 1e6 * found.share[j].value),
                          fmt::format("± {:.3f}", 1.96e6 * found.share[j].standard_error)});
  }
  Section section{"Stray light", {}};
  section.blocks.push_back(line_figure(
      {.id = "share-over-distance",
       .title = "Share over distance",
       .caption = "Share of a pixel's light that each pixel at this distance receives."},
      {shares}, {.label = "distance", .unit = "px", .logarithmic = true},
      {.label = "share", .unit = "ppm"}));
  section.blocks.push_back(std::move(table));
  return finished_calibration_page(
      {.title = fmt::format("Stray light in {}", source),
       .subtitle = fmt::format("{:.3f} % ± {:.3f} of all light is scattered",
                               100.0 * found.total.value, 196.0 * found.total.standard_error),
       .sections = {std::move(section)}},
      found.notes, command_line);
}

}  // namespace tofsmith

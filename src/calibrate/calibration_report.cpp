// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/calibration_reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

std::vector<double> times_ns(Eigen::Index count, double start_s, double step_s) {
  std::vector<double> times;
  for (Eigen::Index i = 0; i < count; ++i)
    times.push_back(1e9 * (start_s + static_cast<double>(i) * step_s));
  return times;
}

/// Adds notes, the command unless it is empty, and the footer.
Page finished_calibration_page(Page page, const std::vector<std::string>& notes,
                               const std::string& command_line) {
  page.footer = "tofsmith " TOFSMITH_VERSION;
  if (!notes.empty()) {
    Table table{.columns = {{"note"}}};
    for (const std::string& note : notes) table.rows.push_back({note});
    page.sections.push_back({"Notes", {std::move(table)}});
  }
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace

std::vector<std::vector<std::string>> response_rows(const CalibratedResponse& found) {
  std::vector<std::vector<std::string>> rows{
      {"kind", "f_max or cutoff (MHz)", "-3 dB (MHz)", "residual (% of height)"}};
  for (const ParametricResponse& fit : found.fits)
    rows.push_back({std::string(name_of(fit.response.kind)), estimate_text(fit.parameter_hz, 1e6),
                    estimate_text(fit.bandwidth_hz, 1e6),
                    fmt::format("{:.3g}", 100 * fit.residual_rms)});
  rows.push_back({"measured", "", estimate_text(found.bandwidth_hz, 1e6), ""});
  return rows;
}

std::vector<std::vector<std::string>> noise_rows(const PhotonTransfer& found) {
  std::vector<std::vector<std::string>> rows{{"quantity", "found"}};
  rows.push_back({"sensor.gain_e_per_dn", estimate_text(found.gain_e_per_dn, 1)});
  rows.push_back({"sensor.read_noise_e", estimate_text(found.read_noise_e, 1)});
  if (found.buckets == 1) {
    rows.push_back({"sensor.black_level_dn", estimate_text(found.black_level_dn, 1)});
    rows.push_back({"sensor.full_well_e",
                    found.full_well_e ? estimate_text(*found.full_well_e, 1) : "not reached"});
  }
  rows.push_back({"sensor.adc_bits", fmt::format("{}", found.adc_bits)});
  rows.push_back({"chi^2 per degree of freedom", fmt::format("{:.3g}", found.reduced_chi2)});
  return rows;
}

Page response_report(const CalibratedResponse& found, const std::string& source,
                     const std::string& command_line) {
  ColourAssignment colours;
  const ResponseRecord& record = found.record;
  const std::vector<double> times =
      times_ns(record.values.size(), record.start_time_s, record.time_step_s);
  std::vector<Series> recorded{{.name = "record", .x = times, .y = to_values(record.values)}};
  recorded.back().style = reference_style();
  const ParametricResponse& best = found.fits.front();
  recorded.push_back({.name = fmt::format("{} fit", name_of(best.response.kind)),
                      .x = times,
                      .y = to_values(best.fit),
                      .style = colours.style("fit")});
  const auto count = static_cast<Eigen::Index>(found.response.samples.size());
  const Series response{.name = "response",
                        .x = times_ns(count, -found.response_centre_s, found.response.time_step_s),
                        .y = found.response.samples,
                        .style = colours.style("response")};
  Series passed{.name = "measured", .style = colours.style("response")};
  Series fitted{.name = std::string(name_of(best.response.kind)), .style = colours.style("fit")};
  for (int i = 0; i <= 200; ++i) {
    const double f_hz = 4 * best.bandwidth_hz.value * i / 200;
    for (auto [series, h] : {std::pair{&passed, &found.response}, {&fitted, &best.response}}) {
      series->x.push_back(f_hz / 1e6);
      series->y.push_back(std::abs(h->transfer(f_hz)));
    }
  }
  Section section{"Impulse response",
                  {table_of_rows("fits", "Fits to the record.", response_rows(found), {0})}};
  section.blocks.push_back(line_figure(
      {.id = "record", .title = "Record and fit", .caption = "Measured record and the best fit."},
      recorded, {.label = "time", .unit = "ns"}, {.label = "record"}));
  section.blocks.push_back(line_figure(
      {.id = "response", .title = "Response", .caption = "Denoised, centred at 0, with sum 1."},
      {response}, {.label = "time", .unit = "ns"}, {.label = "response"}));
  section.blocks.push_back(line_figure({.id = "transfer",
                                        .title = "Transfer function",
                                        .caption = "Amplitude by frequency; -3 dB is 0.707."},
                                       {passed, fitted}, {.label = "frequency", .unit = "MHz"},
                                       {.label = "amplitude", .from_zero = true}));
  return finished_calibration_page(
      {.title = fmt::format("Impulse response of {}", source), .sections = {std::move(section)}},
      found.notes, command_line);
}

Page noise_report(const PhotonTransfer& found, const std::string& command_line) {
  ColourAssignment colours;
  Series used{.name = "pairs of frames", .mark = Mark::markers, .style = colours.style("pairs")};
  Series left{.name = "saturated", .mark = Mark::markers, .style = colours.style("saturated")};
  double brightest = found.black_level_dn.value;
  for (const PhotonTransferPoint& p : found.points) {
    Series& series = p.saturated ? left : used;
    series.x.push_back(p.mean_dn);
    series.y.push_back(p.variance_dn2.value);
    series.y_error.push_back(p.variance_dn2.standard_error);
    brightest = std::max(brightest, p.mean_dn);
  }
  Series line{.name = "fit", .style = reference_style()};
  const double gain = found.gain_e_per_dn.value, read_dn = found.read_noise_e.value / gain;
  const double at_black = found.buckets * (read_dn * read_dn + 1.0 / 12);
  for (const double mean : {found.black_level_dn.value, brightest}) {
    line.x.push_back(mean);
    line.y.push_back(at_black + (mean - found.black_level_dn.value) / gain);
  }
  std::vector<Series> series{used, line};
  if (!left.x.empty()) series.push_back(left);
  Section section{
      "Noise", {table_of_rows("noise", "Estimates with standard errors.", noise_rows(found), {0})}};
  section.blocks.push_back(line_figure(
      {.id = "photon-transfer",
       .title = "Photon transfer",
       .caption =
           fmt::format("Temporal variance of each pair and measurement over {}. The slope is 1 / "
                       "gain; the value at the black level is the squared read noise.",
                       found.buckets > 1 ? "the light that both buckets collected" : "its mean")},
      series, {.label = found.buckets > 1 ? "light" : "mean", .unit = "DN"},
      {.label = "variance", .unit = "DN^2", .from_zero = true}));
  return finished_calibration_page({.title = "Noise of a sensor", .sections = {section}},
                                   found.notes, command_line);
}

namespace {

Figure table_figure(const CalibratedCorrelation& found, const std::vector<IdealCodeFit>& fits) {
  const Eigen::MatrixXd& chi = found.table.correlation;
  std::vector<double> place;
  for (Eigen::Index n = 0; n < chi.rows(); ++n)
    place.push_back(static_cast<double>(n) / static_cast<double>(chi.rows()));
  ColourAssignment colours;
  std::vector<Series> series;
  for (Eigen::Index k = 0; k < chi.cols(); ++k) {
    const std::string name = fmt::format("measurement {}", k + 1);
    series.push_back({.name = name,
                      .x = place,
                      .y = to_values(chi.col(k)),
                      .y_error = to_values(4 * found.standard_error.col(k)),
                      .mark = Mark::markers,
                      .style = colours.style(name)});
    if (fits.empty()) continue;
    const Eigen::VectorXd fitted = fits.front().fitted.col(k).array() + chi.col(k).mean();
    LineStyle style = colours.style(name);
    style.dash = Dash::dash;
    series.push_back({.name = fmt::format("{} {}", fits.front().code, k + 1),
                      .x = place,
                      .y = to_values(fitted),
                      .style = style});
  }
  return line_figure({.id = "table",
                      .title = "Measured correlation functions",
                      .caption = "Bars: 4 standard errors. Dashed: best-fitting ideal code with "
                                 "the fitted impulse responses."},
                     series, {.label = "delay", .unit = "periods"}, {.label = "raw number"});
}

Figure harmonics_figure(const IdealCodeFit& fit) {
  Series measured{.name = "measured / ideal", .mark = Mark::markers};
  for (const HarmonicRatio& h : fit.harmonics) {
    measured.x.push_back(h.harmonic);
    measured.y.push_back(h.ratio.value);
    measured.y_error.push_back(h.ratio.standard_error);
  }
  return line_figure(
      {.id = "harmonics",
       .title = "Harmonics",
       .caption = fmt::format("Share of each harmonic of {} that the impulse responses transmit.",
                              fit.code)},
      {measured}, {.label = "harmonic", .from_zero = true}, {.label = "ratio", .from_zero = true});
}

Table fits_table(const std::vector<IdealCodeFit>& fits) {
  Table table{.id = "codes",
              .caption = "Fits of ideal codes to the table.",
              .columns = {{"code"},
                          {"residual (%)", true},
                          {"without response (%)", true},
                          {"delay (periods)", true},
                          {"response"},
                          {"MHz", true}},
              .highlighted_row = 0};
  for (const IdealCodeFit& fit : fits)
    table.rows.push_back(
        {fit.code, fmt::format("{:.2f}", 100 * fit.residual),
         fmt::format("{:.2f}", 100 * fit.ideal_residual), fmt::format("{:.4f}", fit.delay_periods),
         std::string(name_of(fit.response.kind)),
         fit.response.kind == ImpulseResponse::Kind::none ? ""
                                                          : estimate_text(fit.parameter_hz, 1e6)});
  return table;
}

}  // namespace

Page correlation_report(const CalibratedCorrelation& found, const std::vector<IdealCodeFit>& fits,
                        const std::string& source, const std::string& command_line) {
  Page page{.title = fmt::format("Correlation functions of {}", source)};
  Section table{"Table", {table_figure(found, fits)}};
  if (!fits.empty()) {
    table.blocks.push_back(fits_table(fits));
    table.blocks.push_back(harmonics_figure(fits.front()));
  }
  page.sections.push_back(std::move(table));
  if (!found.maps.empty()) {
    Section maps{.title = "Pixels"};
    maps.blocks.push_back(image_figure(
        {.id = "offset-map",
         .title = "Offset",
         .caption = "Difference between decoded and true depth of each pixel."},
        {{.pixels = found.maps.delay_offset_m}},
        {.label = "offset", .unit = "m", .map = ColourMap::diverging, .clip_fraction = 0.01}));
    maps.blocks.push_back(
        image_figure({.id = "gain-map",
                      .title = "Gain",
                      .caption = "Response of each pixel relative to the mean response."},
                     {{.pixels = found.maps.gain}}, {.label = "gain", .clip_fraction = 0.01}));
    page.sections.push_back(std::move(maps));
  }
  return finished_calibration_page(std::move(page), found.notes, command_line);
}

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate/calibration_page.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

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

}  // namespace tofsmith

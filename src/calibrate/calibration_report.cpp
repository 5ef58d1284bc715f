// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/calibration_reports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/calibration_page.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

std::vector<double> times_ns(Eigen::Index count, double start_s, double step_s) {
  std::vector<double> times;
  for (Eigen::Index i = 0; i < count; ++i)
    times.push_back(1e9 * (start_s + static_cast<double>(i) * step_s));
  return times;
}

}  // namespace

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

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/export_report.hpp"

#include <fmt/format.h>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;

KeyValueList description(const WaveformExport& exported) {
  const double frequency_hz = exported.fundamental_frequency_hz;
  KeyValueList list;
  const auto add = [&](std::string key, std::string value) {
    list.entries.push_back({std::move(key), std::move(value)});
  };
  add("format", fmt::format("{}: {}", exported.format.name, exported.format.description));
  add("code", exported.code);
  add("frequency", fmt::format("{:.9g} Hz", frequency_hz));
  for (const auto* generator : {&exported.light, &exported.sensor})
    add(generator == &exported.light ? "light" : "sensor",
        fmt::format("table of {} points, {} of them used, {:.6g} MS/s, {} bits{}",
                    generator->points_in_table(frequency_hz),
                    generator->points_per_period(frequency_hz), generator->sample_rate_hz / 1e6,
                    generator->amplitude_bits,
                    generator->edge_grid_s
                        ? fmt::format(", edges on {:.6g} ns", *generator->edge_grid_s * 1e9)
                        : ""));
  add("tables",
      fmt::format("{} of {} points ({} periods)", exported.waveforms.size(),
                  exported.waveforms.front().points(), exported.waveforms.front().periods));
  return list;
}

}  // namespace

std::vector<Row> generator_report_rows(const std::vector<GeneratorReport>& reports) {
  std::vector<Row> rows{{"generator", "points", "clock (MHz)", "duty nominal", "actual",
                         "mean nominal", "actual", "edge shift (ns)", "rms change"}};
  for (const GeneratorReport& r : reports)
    rows.push_back(
        {fmt::format("{}{}", r.arm == Arm::light ? "m" : "d", r.index + 1),
         fmt::format("{}", r.points_per_period), fmt::format("{:.4g}", r.clock_hz / 1e6),
         fmt::format("{:.4f}", r.duty_nominal), fmt::format("{:.4f}", r.duty_actual),
         fmt::format("{:.4f}", r.mean_nominal), fmt::format("{:.4f}", r.mean_actual),
         r.largest_edge_move_s ? fmt::format("{:.3f}", *r.largest_edge_move_s * 1e9) : "-",
         fmt::format("{:.4g}", r.rms_difference)});
  return rows;
}

std::vector<Row> generator_loss_rows(const GeneratorLoss& loss, DepthErrorKind kind) {
  std::vector<Row> rows{{"signal, ambient (e/s)", "nominal (mm)", "actual (mm)", "/ nominal",
                         "uncalibrated (mm)", "/ nominal"}};
  const auto row = [](std::string name, const Estimate& nominal, const Estimate& actual,
                      const Estimate& uncalibrated) {
    return Row{std::move(name),
               estimate_mm_text(nominal),
               estimate_mm_text(actual),
               fmt::format("{:.3f}", actual.value / nominal.value),
               estimate_mm_text(uncalibrated),
               fmt::format("{:.3f}", uncalibrated.value / nominal.value)};
  };
  const auto error = kind == DepthErrorKind::linear ? &PointDepthError::linear_mde_m
                                                    : &PointDepthError::circular_mde_m;
  for (std::size_t i = 0; i < loss.nominal.points.size(); ++i) {
    const OperatingPoint& point = loss.nominal.points[i].point;
    rows.push_back(row(fmt::format("{:.3g}, {:.3g}", point.signal_e_per_s, point.ambient_e_per_s),
                       loss.nominal.points[i].*error, loss.actual.points[i].*error,
                       loss.uncalibrated.points[i].*error));
  }
  rows.push_back(row("geometric mean", loss.nominal.of(kind).geometric_mean_m,
                     loss.actual.of(kind).geometric_mean_m,
                     loss.uncalibrated.of(kind).geometric_mean_m));
  return rows;
}

Page export_page(const ExportedCode& exported, const std::string& command_line) {
  const CodeSet& code = exported.code;
  const Camera& actual = exported.actual;
  const std::optional<GeneratorLoss>& loss = exported.loss;
  const DepthErrorKind kind = actual.operating.error;
  Page page{.title = fmt::format("{} as {}", code.name(), exported.waveforms.format.name),
            .subtitle = fmt::format("effect of the hardware's limits on {}", actual.name),
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back({"Export", {description(exported.waveforms)}});
  page.sections.push_back(
      {"Waveforms",
       {table_of_rows("generators",
                      "Each waveform as designed (nominal) and as the generator outputs it "
                      "(actual), before the impulse responses.",
                      generator_report_rows(exported.generators), {0}),
        waveform_figure({.id = "waveforms",
                         .title = "Waveforms and correlation functions",
                         .caption = "One row per measurement, over one period. Dotted: as "
                                    "designed, if the generator changes it."},
                        code, actual),
        correlation_figure({.id = "correlation",
                            .title = "Correlation functions",
                            .caption = "Lines: with the waveforms of the generator."},
                           code, actual)}});
  if (loss)
    page.sections.push_back(
        {"Depth error",
         {table_of_rows(
             "loss",
             fmt::format(
                 "{} depth error with nominal waveforms, with actual waveforms, and with actual "
                 "waveforms that are decoded as if they were nominal (uncalibrated). The depths "
                 "and the noise are the same, with {} trials per operating point and seed {}.",
                 kind == DepthErrorKind::linear ? "Linear" : "Circular", loss->nominal.trials,
                 loss->nominal.seed),
             generator_loss_rows(*loss, kind), {0})}});
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith

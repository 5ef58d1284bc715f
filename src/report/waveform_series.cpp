// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/shared/waveform_series.hpp"

#include "camera/shared/actual_code.hpp"

namespace tofsmith {

namespace {

/// A waveform by its steps, not on a grid.
Series stepped(const std::string& name, const Waveform& waveform, double period_ns,
               const LineStyle& style) {
  const StepFunction steps = waveform.steps();
  Series series{.name = name, .period = period_ns, .mark = Mark::steps, .style = style};
  for (std::size_t i = 0; i < steps.values.size(); ++i) {
    series.x.push_back(steps.breakpoints[i] * period_ns);
    series.y.push_back(steps.values[i]);
  }
  return series;
}

}  // namespace

std::vector<double> axis_values(int points, double end) {
  std::vector<double> values(static_cast<std::size_t>(points));
  for (int j = 0; j < points; ++j) values[static_cast<std::size_t>(j)] = end * j / points;
  return values;
}

std::vector<Series> arm_series(const Waveform& nominal, const Waveform& actual,
                               const ImpulseResponse& response, double fundamental_frequency_hz,
                               const LineStyle& style) {
  const double period_ns = 1e9 / fundamental_frequency_hz;
  LineStyle faint = style;
  faint.width_px = 1.0;
  std::vector<Series> series;
  if (!(nominal == actual))
    series.push_back(stepped("as designed", nominal, period_ns, reference_style()));
  if (response.kind == ImpulseResponse::Kind::none) {
    series.push_back(stepped("waveform", actual, period_ns, style));
    return series;
  }
  series.push_back(stepped("waveform", actual, period_ns, faint));
  series.push_back(
      {.name = "after the impulse response",
       .x = axis_values(curve_points, period_ns),
       .y = to_values(arm_output(actual, response, fundamental_frequency_hz, curve_points)),
       .period = period_ns,
       .style = style});
  return series;
}

std::vector<Series> weight_series(std::vector<Series> drive) {
  for (Series& series : drive)
    for (auto& value : series.y) value = 2 * value - 1;
  return drive;
}

std::vector<PanelColumn> waveform_columns(bool is_signed) {
  return {{.title = "Modulation",
           .x = {.label = "time", .unit = "ns"},
           .y = {.label = "power / average", .from_zero = true}},
          {.title = "Demodulation",
           .x = {.label = "time", .unit = "ns"},
           .y = {.label = is_signed ? "weight" : "gain", .from_zero = true}},
          {.title = "Correlation",
           .x = {.label = "depth", .unit = "m"},
           .y = {.label = "value", .from_zero = true}}};
}

}  // namespace tofsmith

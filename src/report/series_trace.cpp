// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/series_trace.hpp"

#include "tofsmith/core/error.hpp"

namespace tofsmith::plotly {
namespace {

/// The series with the point that closes its period, if it has one.
Series closed(Series series) {
  if (!series.period || series.x.empty()) return series;
  series.x.push_back(series.x.front() + *series.period);
  series.y.push_back(series.y.front());
  if (!series.y_error.empty()) series.y_error.push_back(series.y_error.front());
  return series;
}

}  // namespace

Json trace_of(const Series& open_series) {
  require(open_series.x.size() == open_series.y.size(), "Series::y.size", open_series.y.size(),
          "must equal x.size = " + std::to_string(open_series.x.size()));
  require(open_series.y_error.empty() || open_series.y_error.size() == open_series.y.size(),
          "Series::y_error.size", open_series.y_error.size(), "must be 0 or equal y.size");
  const Series series = closed(open_series);
  const bool has_line = series.mark != Mark::markers;
  const bool has_markers = series.mark == Mark::markers || series.mark == Mark::line_and_markers;
  Json trace = {{"type", "scatter"},
                {"name", text(series.name)},
                {"mode", !has_line     ? "markers"
                         : has_markers ? "lines+markers"
                                       : "lines"},
                {"x", numbers(series.x)},
                {"y", numbers(series.y)},
                {"line", line(series.style)},
                {"hovertemplate", "%{x:.4g}, %{y:.4g}"}};
  // Plotly would drop points it takes for collinear and tilt the flat parts of a waveform.
  trace["line"]["simplify"] = false;
  if (series.mark == Mark::steps) trace["line"]["shape"] = "hv";
  if (has_markers) trace["marker"] = {{"color", series.style.colour}, {"size", 6}};
  if (!series.y_error.empty()) {
    trace["error_y"] = {{"type", "data"},
                        {"array", numbers(series.y_error)},
                        {"color", series.style.colour},
                        {"thickness", 1.2},
                        {"width", 3}};
  }
  return trace;
}

std::vector<double> drawn(const std::vector<Series>& series, std::vector<double> Series::*values) {
  std::vector<double> all;
  for (const Series& one : series)
    all.insert(all.end(), (one.*values).begin(), (one.*values).end());
  return all;
}

}  // namespace tofsmith::plotly

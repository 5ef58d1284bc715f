// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

enum class Mark {
  line,              ///< points joined by straight lines
  steps,             ///< a value holds until the next point: binary waveforms, patterns
  line_and_markers,  ///< lines with a dot at every point
  markers            ///< dots alone
};

/// One curve. Values that are not finite leave a gap.
struct Series {
  std::string name = {};
  std::vector<double> x = {};
  std::vector<double> y = {};
  LineStyle style = {};
  Mark mark = Mark::line;
  std::vector<double> y_error = {};   ///< half lengths of error bars; empty for none
  std::optional<double> period = {};  ///< x repeats after this: one more point closes the period
};

/// Curves in one pair of axes. A log y axis makes it a convergence plot.
/// @throws std::invalid_argument if there is no series, or x, y and y_error differ in length
Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y);

/// One column of a grid of panels; its panels share both axes.
struct PanelColumn {
  std::string title = {};
  Axis x = {};
  Axis y = {};
};

/// One row of a grid of panels: the curves of each column.
struct PanelRow {
  std::string title = {};
  std::vector<std::vector<Series>> panels = {};
};

/// A grid of panels, e.g. measurements (rows) by modulation, demodulation and correlation
/// (columns). Series of one name share one legend entry.
/// @throws std::invalid_argument if a row has not one panel per column
Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows);

}  // namespace tofsmith

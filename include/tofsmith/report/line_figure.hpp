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
  std::vector<double> y_error = {};   ///< half lengths of error bars; empty for none
  std::optional<double> period = {};  ///< x repeats after this: one more point closes the period
  Mark mark = Mark::line;
  LineStyle style = {};
};

/// Curves in one pair of axes. A log y axis makes it a convergence plot.
/// @throws std::invalid_argument if there is no series, or x, y and y_error differ in length
Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y);

}  // namespace tofsmith

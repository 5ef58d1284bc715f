// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/line_figure.hpp"

namespace tofsmith {

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

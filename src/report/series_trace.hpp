// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "report/plotly_json.hpp"
#include "tofsmith/report/line_figure.hpp"

namespace tofsmith::plotly {

/// The trace that draws a series.
/// @throws std::invalid_argument if x, y and y_error differ in length
Json trace_of(const Series& series);

/// What the series draw along one axis: all their `values` (&Series::x or &Series::y).
std::vector<double> drawn(const std::vector<Series>& series, std::vector<double> Series::*values);

}  // namespace tofsmith::plotly

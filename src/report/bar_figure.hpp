// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// One value per category.
struct BarSeries {
  std::string name = {};
  std::vector<double> values = {};
  std::vector<double> errors = {};  ///< half lengths of error bars; empty for none
  LineStyle style = {};
};

/// Horizontal bars, first category at the top. On a logarithmic axis, where the length of a bar
/// means nothing, dots take their place.
/// @param category_styles  colours by category instead of by series; empty for none
/// @throws std::invalid_argument if a series or `category_styles` does not fit the categories
Figure bar_figure(FigureText text, const std::vector<std::string>& categories,
                  const std::vector<BarSeries>& series, const Axis& value_axis,
                  const std::vector<LineStyle>& category_styles = {});

}  // namespace tofsmith

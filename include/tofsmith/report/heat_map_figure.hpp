// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// An axis of named places.
struct CategoryAxis {
  std::string label = {};
  std::string unit = {};
  std::vector<std::string> ticks = {};
};

/// Values by row (first row at the bottom) and column; NaN leaves a cell empty.
struct HeatMap {
  std::string title = {};
  Eigen::MatrixXd values = {};
};

struct HeatMapOptions {
  int columns = 3;          ///< panels side by side
  bool show_values = true;  ///< writes every value into its cell, two significant digits
};

/// Heat maps on the same axes with one colour scale, e.g. depth error by operating point, one
/// panel per code.
/// @throws std::invalid_argument unless every map has y.ticks x x.ticks values and the colour
///         scale suits them
Figure heat_map_figure(FigureText text, const std::vector<HeatMap>& maps, const CategoryAxis& x,
                       const CategoryAxis& y, const ColourScale& colours,
                       const HeatMapOptions& options = {});

}  // namespace tofsmith

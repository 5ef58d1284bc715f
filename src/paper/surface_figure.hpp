// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// Heights over a grid.
struct Surface {
  std::string name = {};
  Eigen::MatrixXd values = {};  ///< at (y, x); NaN leaves a hole
  LineStyle style = {};         ///< colour; solid lines are filled in between, dashed ones are not
};

/// Surfaces in one box, each a net of lines in its colour, translucent in between.
/// A browser shows about 16 boxes per page.
/// @param x, y  places of the columns and rows of all surfaces, on axes[0] and axes[1]; the heights
///              are on axes[2]
/// @throws std::invalid_argument unless there is a surface and every one has y.size x x.size values
Figure surface_figure(FigureText text, const std::vector<Surface>& surfaces,
                      const std::vector<double>& x, const std::vector<double>& y,
                      const std::array<Axis, 3>& axes);

}  // namespace tofsmith

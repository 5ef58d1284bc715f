// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// A closed curve in space; the last point is joined to the first.
struct Curve3d {
  std::string title = {};
  Eigen::MatrixX3d points = {};  ///< (N, 3)
  Eigen::VectorXd values = {};   ///< (N): what colours the curve, e.g. depth
};

/// Closed curves, each in its own box and all with one colour scale: coding curves.
/// A browser shows about 16 boxes per page.
/// @throws std::invalid_argument if there is no curve or points and values differ in number
Figure curve_3d_figure(FigureText text, const std::vector<Curve3d>& curves,
                       const std::array<Axis, 3>& axes, const ColourScale& colours);

struct PointCloudOptions {
  int max_points = 40000;      ///< a larger cloud is thinned at random; the caption says so
  double point_size_px = 2.2;  ///< diameter
};

/// Points in the camera's frame (x right, y down, z forward) [m], coloured by a value. Points with
/// a coordinate or value that is not finite are left out. The same cloud is always thinned to the
/// same points.
/// @param points  (P, 3)
/// @param values  (P)
/// @throws std::invalid_argument if points and values differ in number
Figure point_cloud_figure(FigureText text, const Eigen::MatrixX3f& points,
                          const Eigen::VectorXf& values, const ColourScale& colours,
                          const PointCloudOptions& options = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "paper/error_surface.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Surfaces of one camera that are shown together.
struct ErrorSurfaceGroup {
  std::string title;  ///< "p = 15, 10 f0"
  std::vector<ErrorSurface> surfaces;

  /// @throws std::invalid_argument if there is none of that name
  const ErrorSurface& of(const std::string& name) const;
};

/// Linear errors in one box with logarithmic axes, as the paper draws them.
Figure surfaces_3d(FigureText text, const ErrorSurfaceGroup& group,
                   const std::vector<std::string>& names);

/// Linear errors as heat maps [mm], one panel per code, one colour scale.
Figure error_heat_maps(FigureText text, const ErrorSurfaceGroup& group,
                       const std::vector<std::string>& names);

/// Ratios over the same grid: beyond 1 red, below blue, as logarithms to base 2.
struct RatioMap {
  std::string title;
  Eigen::MatrixXd ratio;
};
Figure ratio_heat_maps(FigureText text, const std::vector<RatioMap>& maps, const ErrorSurface& grid,
                       int columns);

/// Linear error by signal at A = 1e4 e/s, one panel per camera.
Figure error_by_signal(FigureText text, const std::vector<ErrorSurfaceGroup>& groups,
                       const std::vector<std::string>& names);

/// Geometric means, linear | circular, and the linear error at the named levels, of every code.
Table geometric_mean_table(const std::string& id, const std::string& caption,
                           const ErrorSurfaceGroup& group);

/// Adds PREFIX_linear_mde_m and the like, each (codes, ambient, signal), and both light axes. Codes
/// are in the order of surfaces_csv().
void add_arrays(NpzArrays& arrays, const std::string& prefix, const ErrorSurfaceGroup& group);

/// Every value of every surface: columns light level, errors, standard errors.
std::string surfaces_csv(const std::vector<ErrorSurfaceGroup>& groups);

}  // namespace tofsmith

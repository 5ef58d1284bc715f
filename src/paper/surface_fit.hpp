// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// How outliers are kept out of a fit.
struct SurfaceFitOptions {
  /// Points farther from the surface than this many robust standard deviations (1.4826 times the
  /// median distance) are left out; > 0, infinite = none.
  double trim_sigma = 3.0;
  int samplings = 200;     ///< minimal sets tried for the first guess, >= 1
  std::uint64_t seed = 1;  ///< of their choice

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// A surface through points, and how well it fits those it was made from.
template <typename Surface>
struct SurfaceFit {
  Surface surface;
  int used = 0;        ///< points that were not left out
  double rms_m = 0.0;  ///< of their orthogonal distances
};

/// Least squares of orthogonal distances. The first guess is, of many surfaces through 3 points (4
/// for a sphere), the one with the least median distance, so that up to half of the points may be
/// anywhere; then fitting and leaving out alternate until the points no longer change.
/// @param points  [m]; those that are not finite count for nothing
/// @throws std::invalid_argument if fewer than 3 finite points are left, or all lie on a line
/// @note deterministic
SurfaceFit<Plane> fit_plane(const std::vector<Eigen::Vector3d>& points,
                            const SurfaceFitOptions& options = {});

/// The same for a sphere: an algebraic fit, refined by Gauss-Newton steps. A part of a sphere, as
/// seen from one side, is enough.
/// @throws std::invalid_argument if fewer than 4 finite points are left, or all lie in a plane
SurfaceFit<Sphere> fit_sphere(const std::vector<Eigen::Vector3d>& points,
                              const SurfaceFitOptions& options = {});

/// Depth error of points seen from the origin: distance of the point less the distance at which its
/// own viewing ray meets the surface [m]. NaN for a ray that does not meet it (beside a sphere) and
/// for points that are not finite.
std::vector<double> residuals_along_rays(const Plane& plane,
                                         const std::vector<Eigen::Vector3d>& points);
std::vector<double> residuals_along_rays(const Sphere& sphere,
                                         const std::vector<Eigen::Vector3d>& points);

}  // namespace tofsmith

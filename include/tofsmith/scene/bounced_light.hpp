// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Multipath light of a pixel at one distance.
struct MultipathReturn {
  float distance_m = 0.0f;  ///< half the length of the light path [m], i.e. the apparent depth
  float ratio = 0.0f;       ///< signal relative to the pixel's direct return, >= 0
};

/// A list of multipath returns for every pixel of a scene, row by row.
struct MultipathReturns {
  int height = 0;
  int width = 0;
  std::vector<std::int64_t> first{0};    ///< pixel i has the returns [first[i], first[i + 1])
  std::vector<MultipathReturn> returns;  ///< by increasing distance within a pixel

  MultipathReturns() = default;
  /// Returns an empty list for an image, to be filled by append_pixel().
  MultipathReturns(int height_, int width_) : height(height_), width(width_) {}

  bool empty() const { return returns.empty(); }
  /// Adds the returns of the next pixel, row by row from the top left.
  void append_pixel(std::span<const MultipathReturn> of_pixel);
  std::span<const MultipathReturn> of(int row, int column) const;

  /// @throws std::invalid_argument naming pixel, return, value and rule, unless every pixel has a
  ///         list, distances start at the direct depth, increase and stay within `range_m` of it,
  ///         ratios are finite and not negative, and pixels without a direct return have no other
  void validate(const SceneImage& scene, double range_m) const;
};

/// Adds the same returns to every pixel with a direct return.
/// @param behind  distance_m is the delay relative to the direct return [m]
MultipathReturns behind_every_pixel(const SceneImage& scene,
                                    std::span<const MultipathReturn> behind);

/// Options for simulating light with one additional bounce.
struct BounceOptions {
  int rays = 256;       ///< per pixel, 16 to 65536
  double bin_m = 0.05;  ///< width of the delay bins in which light is merged [m], > 0
  std::uint64_t seed = 1;
  /// Unambiguous range [m], > 0. Light delayed by more than this is moved by whole ranges to its
  /// apparent depth.
  double range_m = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument
  void validate() const;
};

/// Computes the light that travels from the source via one other surface to the surface seen by a
/// pixel, for a point source at the camera's centre and Lambertian surfaces. x1 is the seen point
/// at distance d1 and angle of incidence a1. x2 is hit in a direction drawn from the hemisphere
/// with cosine weights; it is at distance s from x1, and at distance d2 and angle a2 from the
/// source:
///   ratio = d1^2 / cos a1 * mean over directions of albedo(x2) cos(a2) / d2^2, 0 if x2 is not lit;
///   distance = (d1 + d2 + s) / 2.
/// Directions form a lattice with a random rotation per pixel. Every bin of delays becomes one
/// return at its mean distance, which preserves light and mean delay. Pixels without a direct
/// return, or whose surface is seen edge-on, have none.
/// @param search_of  see RayCaster
/// @throws std::invalid_argument if scene or options are invalid; Interrupted if `progress` cancels
/// @note the result does not depend on the number of threads
MultipathReturns bounced_light(const StagedScene& scene, const BounceOptions& options = {},
                               const Progress& progress = {},
                               const MeshSearchMaker& search_of = {});

}  // namespace tofsmith

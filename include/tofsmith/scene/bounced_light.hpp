// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Multipath light of a pixel at one distance.
struct MultipathReturn {
  float distance_m = 0.0f;  ///< half the length of the light path, i.e. the apparent depth
  float ratio = 0.0f;       ///< relative to the pixel's direct return, >= 0
};

/// Multipath returns of every pixel, row by row.
struct MultipathReturns {
  int height = 0;
  int width = 0;
  std::vector<std::int64_t> first{0};    ///< pixel i has the returns [first[i], first[i + 1])
  std::vector<MultipathReturn> returns;  ///< by increasing distance within a pixel

  MultipathReturns() = default;
  /// No returns yet, see append_pixel().
  MultipathReturns(int height_, int width_) : height(height_), width(width_) {}

  bool empty() const { return returns.empty(); }
  /// Adds the returns of the next pixel.
  void append_pixel(std::span<const MultipathReturn> of_pixel);
  std::span<const MultipathReturn> of(int row, int column) const;

  /// @throws std::invalid_argument naming pixel, return, value and rule, unless every pixel has a
  ///         list, distances increase from the direct depth and stay within `range_m` of it, ratios
  ///         are finite and not negative, and pixels without a direct return have no other
  void validate(const SceneImage& scene, double range_m) const;
};

/// Adds the same returns to every pixel with a direct return.
/// @param behind  distance_m is relative to the direct return
MultipathReturns behind_every_pixel(const SceneImage& scene,
                                    std::span<const MultipathReturn> behind);

/// Options of bounced_light().
struct BounceOptions {
  int rays = 256;
  double bin_m = 0.05;
  std::uint64_t seed = 1;
  /// Light delayed by more moves by whole ranges to its apparent depth.
  double range_m = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<BounceOptions> auto& o) {
  return std::tuple(
      Field("rays", o.rays, closed(16, 65536),
            Help{"rays per pixel for bounced light; noise decreases slightly faster than 1 / "
                 "sqrt(rays)"}),
      Field("bin_m", o.bin_m, above(0), Help{"width of the delay bins in which light is merged"}),
      Field("seed", o.seed), Field("range_m", o.range_m, above(0).or_infinity()));
}

/// Computes the light that reaches the surface of a pixel via one other surface, for a point source
/// at the camera's centre and Lambertian surfaces. x1 is the seen point at distance d1 and angle of
/// incidence a1. x2 is hit in a direction drawn with cosine weights; it is at distance s from x1,
/// and at distance d2 and angle a2 from the source:
///   ratio = d1^2 / cos a1 * mean over directions of albedo(x2) cos(a2) / d2^2, 0 if x2 is not lit;
///   distance = (d1 + d2 + s) / 2.
/// Directions form a lattice with a random rotation per pixel. Every bin of delays becomes one
/// return, which preserves light and mean delay.
/// @throws std::invalid_argument if scene or options are invalid; Interrupted
MultipathReturns bounced_light(const StagedScene& scene, const BounceOptions& options = {},
                               const Progress& progress = {},
                               const MeshSearchMaker& search_of = {});

}  // namespace tofsmith

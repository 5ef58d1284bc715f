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

/// Multipath light of a pixel that comes at one distance.
struct MultipathReturn {
  float distance_m = 0.0f;  ///< half the way it went [m]: the depth a camera sees it at
  float ratio = 0.0f;       ///< its signal over that of the pixel's direct return, >= 0
};

/// Any number of multipath returns for every pixel of a scene, as one list, row by row.
struct MultipathReturns {
  int height = 0;
  int width = 0;
  std::vector<std::int64_t> first{0};    ///< of pixel i: returns first[i] .. first[i + 1] - 1
  std::vector<MultipathReturn> returns;  ///< of each pixel by increasing distance

  MultipathReturns() = default;
  /// Room for the pixels of a picture, to be filled by append_pixel().
  MultipathReturns(int height_, int width_) : height(height_), width(width_) {}

  bool empty() const { return returns.empty(); }
  /// Adds the next pixel, row by row from the top left.
  void append_pixel(std::span<const MultipathReturn> of_pixel);
  std::span<const MultipathReturn> of(int row, int column) const;

  /// Every pixel has its list; distances increase from the direct depth on and stay within a
  /// range of it; ratios are finite and not negative; pixels without direct return have none.
  /// @throws std::invalid_argument naming pixel, return, value and rule
  void validate(const SceneImage& scene, double range_m) const;
};

/// The same returns behind every direct one.
/// @param behind  distance_m is the delay behind the direct return [m]
MultipathReturns behind_every_pixel(const SceneImage& scene,
                                    std::span<const MultipathReturn> behind);

/// How light is gathered that bounces once more.
struct BounceOptions {
  int rays = 256;       ///< sent from each pixel's surface, 16 .. 65536
  double bin_m = 0.05;  ///< light is merged by delay in bins this wide [m], > 0
  std::uint64_t seed = 1;
  /// Unambiguous range [m], > 0: light that comes later than that behind the direct return is put
  /// where the camera sees it, whole ranges earlier.
  double range_m = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Light that goes from the source over one other surface to the surface a pixel sees, for a point
/// source at the camera's centre and Lambertian surfaces of their own albedo. At a point x1 seen at
/// distance d1 under the angle of incidence a1, with x2 met in a direction of the hemisphere drawn
/// with cosine weights, at distance s from x1, d2 and angle a2 from the source:
///   ratio = d1^2 / cos a1 * mean over directions of albedo(x2) cos(a2) / d2^2, 0 where x2 is not
///   lit; distance = (d1 + d2 + s) / 2.
/// Directions are a lattice turned at random for each pixel. Every bin of delays becomes one return
/// at its mean distance; light and mean delay are kept. Pixels without direct return, or that see
/// their surface edge-on, have none.
/// @param search_of  how meshes are searched: see RayCaster
/// @throws std::invalid_argument if scene or options are invalid; Interrupted if progress says so
/// @note the same for any number of threads
MultipathReturns bounced_light(const StagedScene& scene, const BounceOptions& options = {},
                               const Progress& progress = {},
                               const MeshSearchMaker& search_of = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/later_returns.hpp"
#include "tofsmith/scene/mesh_search.hpp"
#include "tofsmith/scene/staged_scene.hpp"

namespace tofsmith {

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
LaterReturns bounced_light(const StagedScene& scene, const BounceOptions& options = {},
                           const Progress& progress = {}, const MeshSearchMaker& search_of = {});

}  // namespace tofsmith

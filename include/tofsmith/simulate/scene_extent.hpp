// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/array.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// How an image of this size is seen: through the lens, or 60 degrees wide without one.
PinholeView view_of(const std::optional<Lens>& lens, int width, int height);

/// How far away the parts of a scene are, for a camera.
struct SceneExtent {
  std::int64_t pixels = 0;        ///< in all
  std::int64_t returns = 0;       ///< with a depth
  std::int64_t beyond_range = 0;  ///< of these, at or beyond the unambiguous range
  double nearest_m = 0.0;         ///< radial; 0 of no returns
  double median_m = 0.0;
  double farthest_m = 0.0;
  double range_m = 0.0;  ///< unambiguous range of the camera

  double no_return_share() const;     ///< of all pixels
  double beyond_range_share() const;  ///< of the pixels with a depth
};

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera);

/// 1 where depth is at or beyond the camera's unambiguous range: what it measures there is wrapped
/// and looks like a nearer surface. 0 elsewhere and where nothing returns.
Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera);

}  // namespace tofsmith

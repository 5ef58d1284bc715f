// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Depth error of a frame over the pixels with a true depth.
struct SceneError {
  double mean_m = 0.0;  ///< |decoded - true| of pixels with a decoded depth
  double median_m = 0.0;
  double outlier_rate = 0.0;  ///< beyond the threshold or without decoded depth
  double decoded_share = 0.0;
  std::int64_t pixels = 0;  ///< with a true depth
  double outlier_threshold_m = 0.0;
};

/// True distance wrapped to the range; NaN: no return.
Image<float> wrapped_depth_m(const SceneImage& scene, const Camera& camera);

/// Returns decoded - true [m]; NaN where unknown. @throws std::invalid_argument if the sizes differ
Image<float> depth_difference_m(const Image<float>& decoded_m, const SceneImage& scene,
                                const Camera& camera, DepthErrorKind kind);

/// Summarizes the differences.
SceneError scene_error(const Image<float>& decoded_m, const SceneImage& scene, const Camera& camera,
                       DepthErrorKind kind,
                       double outlier_threshold_m = default_outlier_threshold_m);

/// Returns the view of the lens, or 60 degrees wide without one.
/// @throws std::invalid_argument if the lens is for another image size
PinholeView view_of(const std::optional<Lens>& lens, int width, int height);
/// Returns a lens that is valid for any image size.
Lens lens_of(const PinholeView& view);

/// Distances in a scene, compared with a camera's range.
struct SceneExtent {
  std::int64_t pixels = 0;
  std::int64_t returns = 0;       ///< with a depth
  std::int64_t beyond_range = 0;  ///< at or beyond the unambiguous range
  double nearest_m = 0.0;         ///< radial; 0 without returns
  double median_m = 0.0;
  double farthest_m = 0.0;
  double range_m = 0.0;

  double no_return_share() const;     ///< of all pixels
  double beyond_range_share() const;  ///< of the returns
};

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera);

/// Returns 1 for pixels at or beyond the unambiguous range, whose depth wraps; 0 elsewhere.
Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera);

/// Result of decoding after filtering.
struct FilteredSceneDecoding {
  Image<float> depth_m;
  Image<float> averaged;  ///< see FilteredFrame
  SceneError error;
};

/// Depth of one code.
struct SceneDecoding {
  std::string code;
  Image<float> depth_m;
  SceneError error;
  std::optional<FilteredSceneDecoding> filtered = {};
};

/// A capture at one light level, decoded with several codes.
struct SceneCapture {
  std::string light;  ///< "low", "medium", "high"
  OperatingPoint point;
  std::vector<SceneDecoding> decodings;
};

struct SceneResult {
  std::string name;
  SceneImage truth;
  PinholeView view;
  double reference_distance_m = 1.0;  ///< albedo 1 gives the signal of an operating point
  std::vector<SceneCapture> captures;
};

struct NamedLight {
  std::string name;
  OperatingPoint point;
};

/// Captures and decodes `scene` with every code at every light level, with the same noise.
/// @param filter  if set, filtered measurements are decoded as well
/// @throws std::invalid_argument if scene or camera are invalid or a code does not fit; Interrupted
void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const std::optional<FilterOptions>& filter = {},
                        const Progress& progress = {});

/// Median true depth [m]; 1 if there is none.
double median_depth_m(const SceneImage& scene);

}  // namespace tofsmith

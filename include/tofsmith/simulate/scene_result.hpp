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

/// Depth error of a decoded frame over the pixels with a true depth.
struct SceneError {
  double mean_m = 0.0;         ///< mean |decoded - true| over pixels with a decoded depth
  double median_m = 0.0;       ///< median |decoded - true| over these pixels
  double outlier_rate = 0.0;   ///< share of pixels beyond the threshold or without decoded depth
  double decoded_share = 0.0;  ///< share of pixels with a decoded depth
  std::int64_t pixels = 0;     ///< with a true depth
  double outlier_threshold_m = 0.0;
};

/// True distance wrapped to the camera's range; NaN: no return.
Image<float> wrapped_depth_m(const SceneImage& scene, const Camera& camera);

/// Returns decoded - true [m], linear or circular; NaN where either is unknown.
/// @throws std::invalid_argument if the sizes differ
Image<float> depth_difference_m(const Image<float>& decoded_m, const SceneImage& scene,
                                const Camera& camera, DepthErrorKind kind);

/// Summarizes the differences. @throws std::invalid_argument if the sizes differ
SceneError scene_error(const Image<float>& decoded_m, const SceneImage& scene, const Camera& camera,
                       DepthErrorKind kind,
                       double outlier_threshold_m = default_outlier_threshold_m);

/// Returns the view of images of this size: that of the lens, or 60 degrees wide without one.
/// @throws std::invalid_argument if the lens is for another image size
PinholeView view_of(const std::optional<Lens>& lens, int width, int height);
/// Returns the lens of a view, valid for any image size.
Lens lens_of(const PinholeView& view);

/// Distances in a scene, compared with a camera's range.
struct SceneExtent {
  std::int64_t pixels = 0;        ///< total
  std::int64_t returns = 0;       ///< with a depth
  std::int64_t beyond_range = 0;  ///< of the returns, at or beyond the unambiguous range
  double nearest_m = 0.0;         ///< radial; 0 without returns
  double median_m = 0.0;
  double farthest_m = 0.0;
  double range_m = 0.0;  ///< unambiguous range of the camera

  double no_return_share() const;     ///< of all pixels
  double beyond_range_share() const;  ///< of the pixels with a depth
};

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera);

/// Returns 1 for pixels at or beyond the camera's unambiguous range, whose depth wraps and looks
/// like a nearer surface; 0 elsewhere and without a return.
Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera);

/// Result of decoding the same raw numbers after filtering.
struct FilteredSceneDecoding {
  Image<float> depth_m;
  Image<float> averaged;  ///< number of averaged measurements, see FilteredFrame
  SceneError error;
};

/// Depth of one code from one capture.
struct SceneDecoding {
  std::string code;
  Image<float> depth_m;
  SceneError error;
  std::optional<FilteredSceneDecoding> filtered = {};
};

/// A scene captured at one light level and decoded with several codes.
struct SceneCapture {
  std::string light;  ///< "low", "medium", "high"
  OperatingPoint point;
  std::vector<SceneDecoding> decodings;
};

struct SceneResult {
  std::string name;
  SceneImage truth;
  PinholeView view;
  double reference_distance_m = 1.0;  ///< where albedo 1 gives the signal of an operating point
  std::vector<SceneCapture> captures;
};

struct NamedLight {
  std::string name;
  OperatingPoint point;
};

/// Captures and decodes `scene` with every code at every light level, and stores the captures in
/// it. All codes use the same noise, drawn from `seed`.
/// @param filter  if set, filtered measurements are decoded as well
/// @throws std::invalid_argument if scene or camera are invalid or a code does not fit; Interrupted
///         if `progress` cancels
void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const std::optional<FilterOptions>& filter = {},
                        const Progress& progress = {});

/// Median of the true depths [m]; 1 if there are none.
double median_depth_m(const SceneImage& scene);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

Image<float> wrapped_depth_m(const SceneImage& scene, const Camera& camera) {
  Image<float> wrapped = scene.depth_m;
  for (float& depth : wrapped.pixels)
    if (std::isfinite(depth)) depth = static_cast<float>(wrap(depth, camera.range_m()));
  return wrapped;
}

Image<float> depth_difference_m(const Image<float>& decoded_m, const SceneImage& scene,
                                const Camera& camera, DepthErrorKind kind) {
  require(decoded_m.height == scene.height() && decoded_m.width == scene.width(),
          "size of the decoded depth", fmt::format("{} x {}", decoded_m.height, decoded_m.width),
          fmt::format("must equal the scene's {} x {}", scene.height(), scene.width()));
  const Image<float> truth = wrapped_depth_m(scene, camera);
  Image<float> difference(decoded_m.height, decoded_m.width,
                          std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double d = decoded_m.pixels[i], t = truth.pixels[i];
    if (!std::isfinite(d) || !std::isfinite(t)) continue;
    difference.pixels[i] = static_cast<float>(
        kind == DepthErrorKind::linear ? d - t : circular_difference(d, t, camera.range_m()));
  }
  return difference;
}

SceneError scene_error(const Image<float>& decoded_m, const SceneImage& scene, const Camera& camera,
                       DepthErrorKind kind, double outlier_threshold_m) {
  const Image<float> difference = depth_difference_m(decoded_m, scene, camera, kind);
  SceneError error{.outlier_threshold_m = outlier_threshold_m};
  std::vector<double> sizes;
  std::int64_t outliers = 0;
  for (std::size_t i = 0; i < difference.size(); ++i) {
    if (!std::isfinite(scene.depth_m.pixels[i])) continue;
    ++error.pixels;
    const double size = std::abs(static_cast<double>(difference.pixels[i]));
    if (std::isfinite(size)) {
      sizes.push_back(size);
      error.mean_m += size;
    }
    if (!(size <= outlier_threshold_m)) ++outliers;
  }
  if (error.pixels == 0) return error;
  error.outlier_rate = static_cast<double>(outliers) / static_cast<double>(error.pixels);
  error.decoded_share = static_cast<double>(sizes.size()) / static_cast<double>(error.pixels);
  if (sizes.empty()) return error;
  error.mean_m /= static_cast<double>(sizes.size());
  error.median_m = median_of(std::move(sizes));
  return error;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_preview.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tofsmith/io/colour.hpp"

namespace tofsmith::apps {

PngImage scene_preview(const SceneImage& scene) {
  constexpr double darkest = 0.2;  // of what returns: black means no return
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0.0;
  for (const double depth_m : scene.depth_m.pixels)
    if (std::isfinite(depth_m)) {
      nearest_m = std::min(nearest_m, depth_m);
      farthest_m = std::max(farthest_m, depth_m);
    }
  const double span_m = std::max(farthest_m - nearest_m, 1e-9);

  PngImage png{.height = scene.height(), .width = 2 * scene.width()};
  const auto grey = [&](double value) {
    png.values.push_back(static_cast<std::uint16_t>(std::lround(255.0 * value)));
  };
  for (int row = 0; row < scene.height(); ++row) {
    for (int column = 0; column < scene.width(); ++column) {
      const double depth_m = scene.depth_m(row, column);
      grey(std::isfinite(depth_m) ? 1.0 - (1.0 - darkest) * (depth_m - nearest_m) / span_m : 0.0);
    }
    for (int column = 0; column < scene.width(); ++column) {
      const double light = static_cast<double>(scene.albedo(row, column)) *
                           static_cast<double>(scene.cosine(row, column));
      grey(std::isfinite(scene.depth_m(row, column)) ? srgb_from_linear(light) : 0.0);
    }
  }
  return png;
}

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

template <typename Rule>
void require_plane(const Image<float>& plane, const SceneImage& scene, std::string_view field,
                   std::string_view rule, Rule&& holds) {
  const auto pixels =
      static_cast<std::size_t>(scene.height()) * static_cast<std::size_t>(scene.width());
  require(plane.height == scene.height() && plane.width == scene.width() && plane.size() == pixels,
          fmt::format("{} size", field),
          fmt::format("{} x {} with {} pixels", plane.height, plane.width, plane.size()),
          fmt::format("must equal depth_m's, {} x {}", scene.height(), scene.width()));
  for (int row = 0; row < plane.height; ++row)
    for (int column = 0; column < plane.width; ++column)
      if (!holds(plane(row, column)))
        reject(fmt::format("{}({}, {})", field, row, column), fmt::format("{}", plane(row, column)),
               rule);
}

}  // namespace

SceneImage::SceneImage(int height, int width)
    : depth_m(height, width, std::numeric_limits<float>::quiet_NaN()),
      albedo(height, width, 1.0f),
      cosine(height, width, 1.0f) {}

void SceneImage::validate() const {
  require(height() > 0 && width() > 0, "depth_m size", fmt::format("{} x {}", height(), width()),
          "must have at least one pixel");
  require_plane(depth_m, *this, "depth_m",
                "must be finite and > 0, or NaN for pixels without return",
                [](float v) { return std::isnan(v) || (std::isfinite(v) && v > 0.0f); });
  const auto is_share = [](float v) { return v >= 0.0f && v <= 1.0f; };
  require_plane(albedo, *this, "albedo", "must be in [0, 1]", is_share);
  require_plane(cosine, *this, "cosine", "must be in [0, 1]", is_share);
  if (!ambient_scale.empty())
    require_plane(ambient_scale, *this, "ambient_scale", "must be finite and >= 0",
                  [](float v) { return std::isfinite(v) && v >= 0.0f; });
}

}  // namespace tofsmith

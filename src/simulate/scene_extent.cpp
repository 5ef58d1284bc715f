// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

PinholeView view_of(const std::optional<Lens>& lens, int width, int height) {
  if (!lens) return PinholeView::centred(width, height, std::numbers::pi / 3);
  return {lens->fx_px, lens->fy_px, lens->cx_px, lens->cy_px, width, height};
}

double SceneExtent::no_return_share() const { return share(pixels - returns, pixels); }
double SceneExtent::beyond_range_share() const { return share(beyond_range, returns); }

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera) {
  SceneExtent extent{.pixels = static_cast<std::int64_t>(scene.depth_m.size()),
                     .range_m = camera.range_m()};
  std::vector<double> depths_m;
  for (const float depth_m : scene.depth_m.pixels)
    if (std::isfinite(depth_m)) depths_m.push_back(depth_m);
  extent.returns = static_cast<std::int64_t>(depths_m.size());
  if (depths_m.empty()) return extent;
  const Image<std::uint8_t> beyond = beyond_range(scene, camera);
  extent.beyond_range =
      std::accumulate(beyond.pixels.begin(), beyond.pixels.end(), std::int64_t{0});
  const auto [nearest, farthest] = std::minmax_element(depths_m.begin(), depths_m.end());
  extent.nearest_m = *nearest;
  extent.farthest_m = *farthest;
  extent.median_m = median_of(std::move(depths_m));
  return extent;
}

Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera) {
  Image<std::uint8_t> beyond(scene.height(), scene.width());
  for (std::size_t i = 0; i < beyond.size(); ++i)
    beyond.pixels[i] = scene.depth_m.pixels[i] >= camera.range_m() ? 1 : 0;
  return beyond;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/bounced_light.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

std::string name_of_return(int row, int column, std::size_t number, const char* field) {
  return "return " + std::to_string(number) + " of pixel (" + std::to_string(row) + ", " +
         std::to_string(column) + "): " + field;
}

void validate_pixel(std::span<const MultipathReturn> returns, int row, int column, double direct_m,
                    double range_m) {
  double before_m = direct_m;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto [distance_m, ratio] = returns[i];
    const auto name = [&](const char* field) { return name_of_return(row, column, i, field); };
    require(std::isfinite(ratio) && ratio >= 0.0f, name("ratio"), ratio, "must be finite and >= 0");
    require(!std::isnan(direct_m), name("distance_m"), distance_m,
            "must not exist, because the pixel has no direct return");
    require(std::isfinite(distance_m) && distance_m >= before_m, name("distance_m"), distance_m,
            i == 0 ? "must be finite and not nearer than the direct return at " +
                         fmt::format("{:f}", before_m) + " m"
                   : "must be finite and in order, not nearer than the previous return at " +
                         fmt::format("{:f}", before_m) + " m");
    require(distance_m - direct_m < range_m, name("distance_m"), distance_m,
            "must be less than the unambiguous range, " + fmt::format("{:f}", range_m) +
                " m, behind the direct return at " + fmt::format("{:f}", direct_m) + " m");
    before_m = distance_m;
  }
}

}  // namespace

void MultipathReturns::append_pixel(std::span<const MultipathReturn> of_pixel) {
  returns.insert(returns.end(), of_pixel.begin(), of_pixel.end());
  first.push_back(static_cast<std::int64_t>(returns.size()));
}

std::span<const MultipathReturn> MultipathReturns::of(int row, int column) const {
  const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column);
  return std::span(returns).subspan(static_cast<std::size_t>(first[pixel]),
                                    static_cast<std::size_t>(first[pixel + 1] - first[pixel]));
}

void MultipathReturns::validate(const SceneImage& scene, double range_m) const {
  require(height == scene.height(), "multipath returns: height", height,
          "must equal the scene's " + std::to_string(scene.height()));
  require(width == scene.width(), "multipath returns: width", width,
          "must equal the scene's " + std::to_string(scene.width()));
  const std::size_t pixels = scene.depth_m.size();
  require(first.size() == pixels + 1, "multipath returns: entries of first", first.size(),
          "must be one more than the scene's " + std::to_string(pixels) + " pixels");
  require(first.front() == 0, "multipath returns: first[0]", first.front(), "must be 0");
  for (std::size_t i = 0; i < pixels; ++i)
    require(first[i + 1] >= first[i], "multipath returns: first[" + std::to_string(i + 1) + "]",
            first[i + 1], "must not decrease");
  require(first.back() == static_cast<std::int64_t>(returns.size()),
          "multipath returns: last entry of first", first.back(),
          "must be the number of returns, " + std::to_string(returns.size()));
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      validate_pixel(of(row, column), row, column, scene.depth_m(row, column), range_m);
}

MultipathReturns behind_every_pixel(const SceneImage& scene,
                                    std::span<const MultipathReturn> behind) {
  MultipathReturns result(scene.height(), scene.width());
  std::vector<MultipathReturn> of_pixel;
  for (const float depth_m : scene.depth_m.pixels) {
    of_pixel.clear();
    if (!std::isnan(depth_m))
      for (const MultipathReturn& r : behind) of_pixel.push_back({depth_m + r.distance_m, r.ratio});
    result.append_pixel(of_pixel);
  }
  return result;
}

}  // namespace tofsmith

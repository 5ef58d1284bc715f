// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Light that reaches a pixel by a longer way than the direct light does.
struct LaterReturn {
  float distance_m = 0.0f;  ///< half the way it went [m]: the depth a camera sees it at
  float ratio = 0.0f;       ///< its signal over that of the pixel's direct return, >= 0
};

/// Any number of later returns for every pixel of a scene, as one list, row by row.
struct LaterReturns {
  int height = 0;
  int width = 0;
  std::vector<std::int64_t> first{0};  ///< of pixel i: returns first[i] .. first[i + 1] - 1
  std::vector<LaterReturn> returns;    ///< of each pixel by increasing distance

  LaterReturns() = default;
  /// Room for the pixels of a picture, to be filled by append_pixel().
  LaterReturns(int height_, int width_) : height(height_), width(width_) {}

  bool empty() const { return returns.empty(); }
  /// Adds the next pixel, row by row from the top left.
  void append_pixel(std::span<const LaterReturn> of_pixel);
  std::span<const LaterReturn> of(int row, int column) const;

  /// Every pixel has its list; distances increase from the direct depth on and stay within a
  /// range of it; ratios are finite and not negative; pixels without direct return have none.
  /// @throws std::invalid_argument naming pixel, return, value and rule
  void validate(const SceneImage& scene, double range_m) const;
};

/// The same returns behind every direct one.
/// @param behind  distance_m is the delay behind the direct return [m]
LaterReturns behind_every_pixel(const SceneImage& scene, std::span<const LaterReturn> behind);

}  // namespace tofsmith

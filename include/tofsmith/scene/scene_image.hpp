// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/array.hpp"

namespace tofsmith {

/// What a camera looks at, pixel by pixel; all planes are (H, W).
struct SceneImage {
  Image<float> depth_m;  ///< radial distance from the camera [m], > 0; NaN = no return
  Image<float> albedo;   ///< share of light that is reflected, [0, 1]
  Image<float> cosine;   ///< of the angle of incidence, [0, 1]; 1 where unknown
  Image<float>
      ambient_scale;  ///< ambient light relative to the scene's, >= 0; empty = 1 everywhere

  SceneImage() = default;
  /// No return anywhere, albedo and cosine 1.
  SceneImage(int height, int width);

  int height() const { return depth_m.height; }
  int width() const { return depth_m.width; }

  /// @throws std::invalid_argument naming plane and pixel, value and the rule it breaks
  void validate() const;
};

}  // namespace tofsmith

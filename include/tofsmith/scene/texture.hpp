// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/array.hpp"

namespace tofsmith {

/// How a surface reflects: one albedo, two that alternate, or a picture.
struct Texture {
  enum class Pattern { uniform, checker, stripes, image };
  Pattern pattern = Pattern::uniform;
  double albedo = 0.5;        ///< [0, 1]; scales the values of an image
  double other_albedo = 0.5;  ///< of every second field, [0, 1]
  double period_m = 0.1;  ///< width of a field or of the image [m], > 0; on a sphere measured along
                          ///< its equator
  /// Albedo, linear, each value in [0, 1]; repeats in both directions, rows run against the second
  /// coordinate. Meshes with texture coordinates lay it over [0, 1] x [0, 1], whatever period_m.
  Image<float> image;

  /// Albedo at surface coordinates [m]; stripes alternate along the first.
  double at(double first_m, double second_m) const;
  /// Albedo of the image at texture coordinates, u to the right, v up; the nearest pixel.
  double image_at(double u, double v) const;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/error_map.hpp"

namespace tofsmith {

Image<float> scaled(Image<float> image, double factor) {
  for (float& value : image.pixels) value = static_cast<float>(value * factor);
  return image;
}

ColourScale depth_error_scale(double limit_mm) {
  return {.label = "error",
          .unit = "mm",
          .map = ColourMap::diverging,
          .range = ValueRange{-limit_mm, limit_mm}};
}

}  // namespace tofsmith

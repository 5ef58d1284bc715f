// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/shapes.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

double Texture::at(double first_m, double second_m) const {
  if (pattern == Pattern::uniform) return albedo;
  if (pattern == Pattern::image) {
    const double height_m = period_m * image.height / image.width;
    return image_at(first_m / period_m, second_m / height_m);
  }
  double field = std::floor(first_m / period_m);
  if (pattern == Pattern::checker) field += std::floor(second_m / period_m);
  return std::fmod(std::abs(field), 2.0) == 0.0 ? albedo : other_albedo;
}

double Texture::image_at(double u, double v) const {
  const auto pixel = [](double position, int count) {
    const double share = position - std::floor(position);
    return share >= 0.0 ? std::min(count - 1, static_cast<int>(share * count)) : 0;  // 0 for NaN
  };
  return albedo * image(pixel(-v, image.height), pixel(u, image.width));
}

void Texture::validate() const {
  for (const double value : {albedo, other_albedo})
    require(value >= 0.0 && value <= 1.0, "texture.albedo", value, "must be in [0, 1]");
  require(std::isfinite(period_m) && period_m > 0.0, "texture.period_m", period_m,
          "must be finite and > 0");
  if (pattern != Pattern::image) return;
  require(!image.empty(), "texture.image", "no pixels", "must have some");
  for (const float value : image.pixels)
    require(value >= 0.0f && value <= 1.0f, "texture.image", value, "must be in [0, 1]");
}

}  // namespace tofsmith

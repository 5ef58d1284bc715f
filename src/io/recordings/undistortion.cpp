// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/undistortion.hpp"

#include <cmath>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

Undistortion::Undistortion(const PinholeView& view) {
  const PixelRays rays(view);
  const PinholeView ideal = view.ideal();
  const auto width = static_cast<std::size_t>(view.width);
  source_.assign(static_cast<std::size_t>(view.height) * width, -1);
  radial_ratio_.assign(source_.size(), 1.0f);
  parallel_for(view.height, [&](std::int64_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < view.width; ++column) {
      const auto seen_at = view.pixel_of(ideal.ray(row, column));
      if (!seen_at) continue;
      const double at_row = std::round(seen_at->y()), at_column = std::round(seen_at->x());
      if (!(at_row >= 0.0 && at_row < view.height && at_column >= 0.0 && at_column < view.width))
        continue;
      const int source_row = static_cast<int>(at_row), source_column = static_cast<int>(at_column);
      const std::size_t pixel =
          static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
      source_[pixel] = source_row * view.width + source_column;
      radial_ratio_[pixel] = static_cast<float>(ideal.radial_per_z(row, column) /
                                                rays.radial_per_z(source_row, source_column));
    }
  });
}

std::size_t Undistortion::bytes() const {
  constexpr std::size_t largest_item = sizeof(float);
  return source_.size() * (sizeof(std::int32_t) + sizeof(float) + largest_item);
}

void Undistortion::turn_radial(Image<float>& depth_m) const {
  for (std::size_t i = 0; i < radial_ratio_.size(); ++i) depth_m.pixels[i] *= radial_ratio_[i];
}

}  // namespace tofsmith

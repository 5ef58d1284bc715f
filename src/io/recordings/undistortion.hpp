// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Resamples images to the ideal pinhole. Each pixel has the values of the source pixel nearest to
/// its ray, so that depths are not mixed.
class Undistortion {
 public:
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit Undistortion(const PinholeView& view);

  /// Memory, including one plane during resampling [bytes].
  std::size_t bytes() const;

  /// @param none  value of pixels that the image does not cover
  template <typename Value>
  void apply(Image<Value>& plane, Value none) const {
    const std::vector<Value> from = plane.pixels;
    for (std::size_t i = 0; i < source_.size(); ++i)
      plane.pixels[i] = source_[i] < 0 ? none : from[static_cast<std::size_t>(source_[i])];
  }
  /// Converts radial distances after apply(), so that z does not change.
  void turn_radial(Image<float>& depth_m) const;

 private:
  std::vector<std::int32_t> source_;  // source pixel of each pixel; -1: none
  std::vector<float> radial_ratio_;   // of the pixel's ray to the source's ray, at the same z
};

}  // namespace tofsmith

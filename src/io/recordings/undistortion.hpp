// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// How an image through a lens that distorts becomes that of the ideal pinhole: every pixel takes
/// the values of the one nearest to where its ray is seen, so that no two depths are mixed.
class Undistortion {
 public:
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit Undistortion(const PinholeView& view);

  /// What it takes, with a plane that is being turned [bytes].
  std::size_t bytes() const;

  /// @param none  of pixels that no pixel of the image looks at
  template <typename Value>
  void apply(Image<Value>& plane, Value none) const {
    const std::vector<Value> from = plane.pixels;
    for (std::size_t i = 0; i < source_.size(); ++i)
      plane.pixels[i] = source_[i] < 0 ? none : from[static_cast<std::size_t>(source_[i])];
  }
  /// After apply(): radial distances, so that depth along the axis stays what it was measured as.
  void turn_radial(Image<float>& depth_m) const;

 private:
  std::vector<std::int32_t> source_;  // of every pixel; -1: none
  std::vector<float> radial_ratio_;   // of its ray to that of its source, at the same z
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "tofsmith/core/array.hpp"

namespace tofsmith {

/// The raw numbers of one frame where they are, in any of four types and any regular layout: number
/// k of the pixel at (row, column) stands row * row_stride + column * column_stride +
/// k * measurement_stride elements after the first. Owns nothing.
struct RawView {
  std::variant<const float*, const double*, const std::uint16_t*, const std::uint8_t*> data;
  int height = 0;
  int width = 0;
  int measurements = 0;
  std::ptrdiff_t row_stride = 0;          ///< [elements]
  std::ptrdiff_t column_stride = 0;       ///< [elements]
  std::ptrdiff_t measurement_stride = 0;  ///< [elements]

  std::int64_t pixels() const { return std::int64_t{height} * width; }

  /// (H, W, K), the measurements of a pixel side by side.
  template <typename Number>
  static RawView interleaved(const Number* data, int height, int width, int measurements) {
    return {data,         height, width, measurements, std::ptrdiff_t{width} * measurements,
            measurements, 1};
  }
  /// (K, H, W), one image per measurement.
  template <typename Number>
  static RawView planar(const Number* data, int height, int width, int measurements) {
    return {data, height, width, measurements, width, 1, std::ptrdiff_t{height} * width};
  }
};

/// Frame f of several.
/// @throws std::invalid_argument if there is no such frame, or not as many values as the sizes say
RawView view_of_frame(const RawFrames& raw, int frame);

/// Copies pixels first .. first + count - 1 (row by row) as float, the measurements of a pixel side
/// by side; doubles are rounded.
void copy_pixels(const RawView& raw, std::int64_t first, std::int64_t count, float* values);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace tofsmith {

/// H x W values, row by row from the top left.
template <typename Value>
struct Image {
  int height = 0;
  int width = 0;
  std::vector<Value> pixels;

  Image() = default;
  Image(int height_, int width_, Value fill = Value{})
      : height(height_),
        width(width_),
        pixels(static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_), fill) {}

  std::size_t size() const { return pixels.size(); }
  bool empty() const { return pixels.empty(); }
  Value& operator()(int row, int column) { return pixels[index(row, column)]; }
  const Value& operator()(int row, int column) const { return pixels[index(row, column)]; }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// Raw measurements (F, H, W, K), last axis fastest: electrons, or counts if the sensor has an ADC.
struct RawFrames {
  int frames = 0;
  int height = 0;
  int width = 0;
  int measurements = 0;
  std::vector<float> values;

  std::size_t pixels_per_frame() const {
    return static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  }
  const float* frame(int f) const {
    return values.data() + static_cast<std::size_t>(f) * pixels_per_frame() *
                               static_cast<std::size_t>(measurements);
  }
  float* frame(int f) { return const_cast<float*>(static_cast<const RawFrames*>(this)->frame(f)); }
};

/// Variances of filtered numbers, relative to the variance of depth given by `RawView::averaged`.
struct NoiseRatios {
  float of_lobes = 1.0f;     ///< between lobes, for confidence
  float of_residual = 1.0f;  ///< of the component that no depth explains

  /// Ratios of a pixel: 1 unless it is a mean.
  NoiseRatios at(float averaged) const { return averaged > 1.0f ? *this : NoiseRatios(); }
};

/// View of the raw numbers of one frame in any regular layout: number k of the pixel at (row,
/// column) is at offset row * row_stride + column * column_stride + k * measurement_stride
/// [elements].
struct RawView {
  std::variant<const float*, const double*, const std::uint16_t*, const std::uint8_t*> data;
  int height = 0;
  int width = 0;
  int measurements = 0;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t column_stride = 0;
  std::ptrdiff_t measurement_stride = 0;
  /// Number of equal measurements averaged in a pixel, > 0 (H, W); divides the variance. Null: 1.
  const float* averaged = nullptr;
  NoiseRatios noise;  ///< of pixels with `averaged` > 1
  /// The numbers are converted unsigned integers.
  bool was_unsigned = false;
  /// Special numbers have been replaced already (RawMarking).
  bool is_marked = false;

  std::int64_t pixels() const { return std::int64_t{height} * width; }
  bool is_unsigned() const {
    return was_unsigned || std::holds_alternative<const std::uint8_t*>(data) ||
           std::holds_alternative<const std::uint16_t*>(data);
  }

  /// Layout (H, W, K).
  template <typename Number>
  static RawView interleaved(const Number* data, int height, int width, int measurements) {
    return {data,         height, width, measurements, std::ptrdiff_t{width} * measurements,
            measurements, 1};
  }
  /// Layout (K, H, W).
  template <typename Number>
  static RawView planar(const Number* data, int height, int width, int measurements) {
    return {data, height, width, measurements, width, 1, std::ptrdiff_t{height} * width};
  }
};

/// @throws InvalidArgument if there is no such frame, or the number of values differs from the
///          shape
RawView view_of_frame(const RawFrames& raw, int frame);

/// Copies pixels [first, first + count) as float, (count, K); doubles are rounded.
void copy_pixels(const RawView& raw, std::int64_t first, std::int64_t count, float* values);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tofsmith {

/// A picture of H x W values, row by row from the top left.
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

/// Raw measurements of one or more frames, (F, H, W, K), last axis fastest: electrons, or counts
/// when the sensor has an ADC.
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

}  // namespace tofsmith

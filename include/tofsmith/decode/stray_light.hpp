// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Model of stray light: for light x the sensor receives (1 - s) x + kernel * x, where s is the sum
/// of the kernel. Light scattered out of the image is lost; light scattered into it from outside is
/// not removed. Caches data for one frame size; not thread-safe.
class StrayLight {
 public:
  /// @param kernel  (2 R + 1, 2 Q + 1): fraction of a pixel's light that reaches each surrounding
  ///   pixel; the centre is the pixel itself
  /// @throws InvalidArgument unless both sizes are odd, all values are finite and >= 0, and their
  ///   sum is < 0.5
  explicit StrayLight(Image<float> kernel);

  const Image<float>& kernel() const { return kernel_; }
  /// s, the scattered fraction of all light.
  double share() const { return share_; }
  /// Memory of remove() [bytes].
  double memory_bytes(int height, int width, int measurements) const;

  /// Returns the light that the sensor receives for light (H, W).
  Image<float> scatter(const Image<float>& light);
  /// Inverts scatter(): iterates x <- (y - kernel * x) / (1 - s) until x changes by less than 1e-6
  /// of its largest value, at most 60 times.
  Image<float> gather(const Image<float>& seen);
  /// Applies gather() to each measurement of a frame. Saturated and invalid pixels keep their
  /// values; they are assumed to scatter their measured light and none, respectively.
  /// @param table  provides the black and saturation levels
  /// @param clean  (1, H, W, K), with about the noise of the raw values
  /// @throws InvalidArgument if the measurements differ
  void remove(const RawView& raw, const DecodingTable& table, RawFrames& clean);

 private:
  struct Plan;
  const Plan& plan_of(int height, int width);
  Image<float> gathered(const Plan& plan, const Image<float>& seen) const;

  Image<float> kernel_;
  double share_ = 0.0;
  Hidden<Plan> plan_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "simulate/pixel_capture.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Weights of rays in a pixel along one axis. Each of `samples` equidistant rays represents the
/// light of its part of the pixel, spread by a Gaussian:
///   w_j = integral over part j of [Phi((1/2 - s) / sigma) - Phi((-1/2 - s) / sigma)] ds,
/// with s from the pixel's centre [px]. Exact for scenes that are constant over each part.
struct AxisKernel {
  int reach = 0;                ///< relevant rays beyond each side of the pixel
  std::vector<double> weights;  ///< of rays -reach to samples - 1 + reach; sum 1

  /// @param sigma_px  0: only the rays of the pixel
  AxisKernel(double sigma_px, int samples);
};

/// Distribution of a disc over the pixels around its ray.
struct DiscKernel {
  int reach = 0;                ///< pixels to either side
  std::vector<double> weights;  ///< (2 reach + 1)^2, row by row; sum 1
  double largest = 0.0;

  double at(int row, int column) const {
    const std::ptrdiff_t side = 2 * std::ptrdiff_t{reach} + 1;
    return weights[static_cast<std::size_t>((row + reach) * side + column + reach)];
  }
};

/// Area of the disc about the origin within [x0, x1] x [y0, y1].
double disc_area(double radius, double x0, double x1, double y0, double y1);

/// Discs of confusion, with radii in steps of 2 %.
class DiscKernels {
 public:
  /// @throws std::invalid_argument if a disc exceeds the largest supported radius
  DiscKernels(const LensBlur& blur, int samples, std::span<const float> distances_m);

  /// Returns the kernel by distance [m] (NaN: infinite) and position among the rays of a pixel.
  const DiscKernel& of(float distance_m, int row, int column) const;
  int reach() const { return reach_; }  ///< maximum [px]

 private:
  static constexpr int sharp = -1;
  int step_of(float distance_m) const;

  LensBlur blur_;
  int samples_;
  int reach_ = 0;
  DiscKernel point_;
  int first_step_ = 0;
  std::vector<std::vector<DiscKernel>> steps_;  // (steps, samples^2); empty: unused step
};

/// Tap values of one exposure or of all.
struct TapRange {
  int first = 0, count = 0;
};

/// Adds the light of rays, blurred by the lens. The image is continued by reflection, so that no
/// light is lost and uniform light remains uniform. Ambient light is added with tap value 0,
/// distances with every tap value. Deterministic.
/// @param rays  `samples` x `samples` per pixel
/// @throws std::invalid_argument if the size of their image does not match, or as DiscKernels
void add_light(const RowCapture& rays, const LensBlur& blur, int samples, TapRange range,
               CollectedLight& light);

/// Applies StrayLight::scatter() to each tap value and to ambient light.
/// @param kernel  of StrayLight; empty: no change
/// @param ambient_e_per_s  used if `light` has no ambient light
/// @throws std::invalid_argument as StrayLight
void scatter_light(const Image<float>& kernel, double ambient_e_per_s, CollectedLight& light);

}  // namespace tofsmith

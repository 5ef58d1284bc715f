// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/lens_distortion.hpp"

namespace tofsmith {

/// Planes (H, W) of a scene as seen by a camera.
struct SceneImage {
  Image<float> depth_m;        ///< radial distance, > 0; NaN: no return
  Image<float> albedo;         ///< reflected share of light, [0, 1]
  Image<float> cosine;         ///< of the angle of incidence, [0, 1]; 1 if unknown
  Image<float> ambient_scale;  ///< relative to the scene's light, >= 0; empty: 1

  SceneImage() = default;
  /// No return anywhere; albedo and cosine are 1.
  SceneImage(int height, int width);

  int height() const { return depth_m.height; }
  int width() const { return depth_m.width; }

  /// @throws std::invalid_argument naming plane, pixel, value and rule
  void validate() const;
};

/// A pinhole camera at the origin: x to the right, y down, z along the optical axis. Pixel centres
/// have integer coordinates.
struct PinholeView {
  double fx_px = 0.0;  ///< > 0
  double fy_px = 0.0;  ///< > 0
  double cx_px = 0.0;  ///< column of the optical axis
  double cy_px = 0.0;  ///< row of the optical axis
  int width = 0;
  int height = 0;
  std::optional<LensDistortion> distortion = {};

  /// View with square pixels and the optical axis in the middle of the image.
  /// @param horizontal_angle_rad  between the outer edges of the image, in (0, pi)
  static PinholeView centred(int width, int height, double horizontal_angle_rad);

  /// Divides each pixel into n x n pixels.
  PinholeView divided(int n) const;

  /// Returns the view without distortion.
  PinholeView ideal() const;

  /// Returns the unit vector along a pixel's line of sight; NaN where the distortion folds back.
  /// PixelRays is faster with distortion.
  Eigen::Vector3d ray(int row, int column) const;
  /// Ratio of radial distance to z-depth in a pixel, >= 1; NaN where ray() is.
  double radial_per_z(int row, int column) const;
  /// Projects a point to (column, row) [px], also outside the image; none behind the camera and
  /// where the distortion folds back.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const;

  /// @throws std::invalid_argument, also if the distortion folds back inside the image
  void validate() const;
};

/// Rays of all pixels, cached if the lens has distortion.
class PixelRays {
 public:
  /// No pixels.
  PixelRays() = default;
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit PixelRays(PinholeView view);
  /// Uses rays from the camera's manufacturer instead.
  /// @param slopes  x/z and y/z of every pixel, row by row; NaN: none
  /// @throws std::invalid_argument also unless there is one per pixel
  PixelRays(PinholeView view, std::vector<Eigen::Vector2d> slopes);

  const PinholeView& view() const { return view_; }
  Eigen::Vector3d ray(int row, int column) const;
  double radial_per_z(int row, int column) const;
  /// Memory in addition to the view [bytes].
  std::size_t bytes() const { return slopes_.size() * sizeof(Eigen::Vector2d); }

 private:
  Eigen::Vector3d at_unit_z(int row, int column) const;

  PinholeView view_;
  std::vector<Eigen::Vector2d> slopes_;
};

/// Converts z-depth to radial distance. @throws std::invalid_argument if the sizes differ
Image<float> radial_from_z(const Image<float>& z_m, const PinholeView& view);
Image<float> radial_from_z(const Image<float>& z_m, const PixelRays& rays);
/// Inverse of radial_from_z().
Image<float> z_from_radial(const Image<float>& radial_m, const PinholeView& view);
Image<float> z_from_radial(const Image<float>& radial_m, const PixelRays& rays);

}  // namespace tofsmith

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
  Image<float> depth_m;        ///< radial distance from the camera [m], > 0; NaN: no return
  Image<float> albedo;         ///< reflected share of light, [0, 1]
  Image<float> cosine;         ///< cosine of the angle of incidence, [0, 1]; 1 if unknown
  Image<float> ambient_scale;  ///< ambient light relative to the scene's, >= 0; empty: 1 everywhere

  SceneImage() = default;
  /// No return anywhere; albedo and cosine are 1.
  SceneImage(int height, int width);

  int height() const { return depth_m.height; }
  int width() const { return depth_m.width; }

  /// @throws std::invalid_argument naming plane, pixel, value and rule
  void validate() const;
};

/// A pinhole camera at the origin, optionally with lens distortion: x to the right, y down, z along
/// the optical axis. Pixel (row v, column u) has its centre at integer coordinates.
struct PinholeView {
  double fx_px = 0.0;                             ///< focal length in columns [px], > 0
  double fy_px = 0.0;                             ///< focal length in rows [px], > 0
  double cx_px = 0.0;                             ///< column of the optical axis [px]
  double cy_px = 0.0;                             ///< row of the optical axis [px]
  int width = 0;                                  ///< columns, > 0
  int height = 0;                                 ///< rows, > 0
  std::optional<LensDistortion> distortion = {};  ///< none: an ideal pinhole

  /// Returns a view with square pixels and the optical axis in the middle of the image.
  /// @param horizontal_angle_rad  between the outer edges of the first and the last column, in (0,
  ///                              pi)
  static PinholeView centred(int width, int height, double horizontal_angle_rad);

  /// Returns the view with each pixel divided into n x n pixels.
  PinholeView divided(int n) const;

  /// Returns the view without distortion.
  PinholeView ideal() const;

  /// Returns the unit vector from the origin along a pixel's line of sight; NaN where the
  /// distortion folds back.
  /// @note distortion requires the solution of an equation; PixelRays caches the rays of all pixels
  Eigen::Vector3d ray(int row, int column) const;
  /// Ratio of radial distance to z-depth in a pixel, >= 1; NaN where ray() is.
  double radial_per_z(int row, int column) const;
  /// Projects a point to (column, row) [px], inside the image or not; none behind the camera and
  /// where the distortion folds back.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const;

  /// @throws std::invalid_argument; also if the distortion folds back inside the image, with the
  ///         pixel and its distance from the axis
  void validate() const;
};

/// The rays of all pixels of a view, cached if the lens has distortion.
class PixelRays {
 public:
  /// No pixels.
  PixelRays() = default;
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit PixelRays(PinholeView view);
  /// Uses rays from the camera's manufacturer instead of the view's own.
  /// @param slopes  x/z and y/z of every pixel, row by row; NaN: the pixel sees nothing
  /// @throws std::invalid_argument also unless there is one per pixel
  PixelRays(PinholeView view, std::vector<Eigen::Vector2d> slopes);

  const PinholeView& view() const { return view_; }
  /// See PinholeView::ray().
  Eigen::Vector3d ray(int row, int column) const;
  /// See PinholeView::radial_per_z().
  double radial_per_z(int row, int column) const;
  /// Memory in addition to the view [bytes].
  std::size_t bytes() const { return slopes_.size() * sizeof(Eigen::Vector2d); }

 private:
  Eigen::Vector3d at_unit_z(int row, int column) const;

  PinholeView view_;
  std::vector<Eigen::Vector2d> slopes_;  // x/z and y/z, row by row; empty: computed by view_
};

/// Converts z-depth to radial distance; NaN stays NaN.
/// @throws std::invalid_argument if the sizes of image and view differ
Image<float> radial_from_z(const Image<float>& z_m, const PinholeView& view);
Image<float> radial_from_z(const Image<float>& z_m, const PixelRays& rays);
/// Converts radial distance to z-depth; NaN stays NaN.
Image<float> z_from_radial(const Image<float>& radial_m, const PinholeView& view);
Image<float> z_from_radial(const Image<float>& radial_m, const PixelRays& rays);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/lens_distortion.hpp"

namespace tofsmith {

/// What a camera looks at, pixel by pixel; all planes are (H, W).
struct SceneImage {
  Image<float> depth_m;  ///< radial distance from the camera [m], > 0; NaN = no return
  Image<float> albedo;   ///< share of light that is reflected, [0, 1]
  Image<float> cosine;   ///< of the angle of incidence, [0, 1]; 1 where unknown
  Image<float>
      ambient_scale;  ///< ambient light relative to the scene's, >= 0; empty = 1 everywhere

  SceneImage() = default;
  /// No return anywhere, albedo and cosine 1.
  SceneImage(int height, int width);

  int height() const { return depth_m.height; }
  int width() const { return depth_m.width; }

  /// @throws std::invalid_argument naming plane and pixel, value and the rule it breaks
  void validate() const;
};

/// A pinhole camera at the origin, ideal unless its lens distorts: x to the right, y down, z along
/// the optical axis. Pixel (row v, column u) has its centre at integer coordinates.
struct PinholeView {
  double fx_px = 0.0;                             ///< focal length in columns [px], > 0
  double fy_px = 0.0;                             ///< focal length in rows [px], > 0
  double cx_px = 0.0;                             ///< column of the optical axis [px]
  double cy_px = 0.0;                             ///< row of the optical axis [px]
  int width = 0;                                  ///< columns, > 0
  int height = 0;                                 ///< rows, > 0
  std::optional<LensDistortion> distortion = {};  ///< none: an ideal pinhole

  /// Square pixels, axis in the middle of the image.
  /// @param horizontal_angle_rad  between the first and the last column's outer edges, in (0, pi)
  static PinholeView centred(int width, int height, double horizontal_angle_rad);

  /// The same view in n x n parts of each pixel, each a pixel of its own.
  PinholeView divided(int n) const;

  /// The same pinhole without distortion.
  PinholeView ideal() const;

  /// Unit vector from the origin of what a pixel's centre sees; NaN where the distortion folds
  /// back.
  /// @note with distortion an equation is solved: PixelRays keeps the rays of all pixels
  Eigen::Vector3d ray(int row, int column) const;
  /// Radial distance over z-depth in a pixel, >= 1; NaN as ray().
  double radial_per_z(int row, int column) const;
  /// Where a point is seen, as (column, row) [px], be it in the image or not; none behind the
  /// camera and where the distortion folds back.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const;

  /// @throws std::invalid_argument naming field, value and rule; also if the distortion folds back
  ///         inside the image, with the pixel and how far from the axis
  void validate() const;
};

/// The rays of all pixels of a view, found once where its lens distorts.
class PixelRays {
 public:
  /// Of no pixels.
  PixelRays() = default;
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit PixelRays(PinholeView view);
  /// Rays as a camera's maker gives them, in place of the view's own.
  /// @param slopes  x/z and y/z of every pixel, row by row; NaN: of pixels that see nothing
  /// @throws std::invalid_argument also unless there is one for each pixel
  PixelRays(PinholeView view, std::vector<Eigen::Vector2d> slopes);

  const PinholeView& view() const { return view_; }
  /// As PinholeView::ray().
  Eigen::Vector3d ray(int row, int column) const;
  /// As PinholeView::radial_per_z().
  double radial_per_z(int row, int column) const;
  /// Memory that they take beside the view [bytes].
  std::size_t bytes() const { return slopes_.size() * sizeof(Eigen::Vector2d); }

 private:
  Eigen::Vector3d at_unit_z(int row, int column) const;

  PinholeView view_;
  std::vector<Eigen::Vector2d> slopes_;  // x/z and y/z, row by row; empty: view_ says
};

/// Radial distance of every pixel from its z-depth; NaN stays NaN.
/// @throws std::invalid_argument if the image is not of the view's size
Image<float> radial_from_z(const Image<float>& z_m, const PinholeView& view);
Image<float> radial_from_z(const Image<float>& z_m, const PixelRays& rays);
/// z-depth of every pixel from its radial distance; NaN stays NaN.
Image<float> z_from_radial(const Image<float>& radial_m, const PinholeView& view);
Image<float> z_from_radial(const Image<float>& radial_m, const PixelRays& rays);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

template <typename Scale>
Image<float> scaled(const Image<float>& image, const PixelRays& rays, Scale&& scale) {
  const PinholeView& view = rays.view();
  require(image.height == view.height && image.width == view.width, "image size",
          fmt::format("{} x {}", image.height, image.width),
          fmt::format("must equal the view's, {} x {}", view.height, view.width));
  Image<float> result = image;
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column)
      result(row, column) =
          static_cast<float>(image(row, column) * scale(rays.radial_per_z(row, column)));
  return result;
}

/// Position of a pixel in the plane z = 1, including distortion.
Eigen::Vector2d place_of(const PinholeView& view, int row, int column) {
  return {(column - view.cx_px) / view.fx_px, (row - view.cy_px) / view.fy_px};
}

/// Point of a pixel's ray at z = 1, without distortion.
Eigen::Vector3d at_unit_z(const PinholeView& view, int row, int column) {
  Eigen::Vector2d place = place_of(view, row, column);
  if (view.distortion) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    place = view.distortion->undistort(place).value_or(Eigen::Vector2d(nan, nan));
  }
  return {place.x(), place.y(), 1.0};
}

/// Border pixels only: other pixels are between them and the axis.
void check_no_fold(const PinholeView& view) {
  const auto check = [&](int row, int column) {
    const Eigen::Vector2d place = place_of(view, row, column);
    const double reach = view.distortion->reach(place);
    if (reach >= 1.0) return;
    const double radius_px = std::hypot(column - view.cx_px, row - view.cy_px);
    reject("lens.distortion", fmt::format("[{}]", fmt::join(view.distortion->coefficients, ", ")),
           fmt::format("must not fold back {}inside the image: it does so {:.4g} px from the axis, "
                       "towards pixel (row {}, column {}), which is {:.4g} px from the axis",
                       view.distortion->model == DistortionModel::fisheye
                           ? "or look 90 degrees off the axis "
                           : "",
                       reach * radius_px, row, column, radius_px));
  };
  for (const int row : {0, view.height - 1})
    for (int column = 0; column < view.width; ++column) check(row, column);
  for (const int column : {0, view.width - 1})
    for (int row = 0; row < view.height; ++row) check(row, column);
}

}  // namespace

PinholeView PinholeView::centred(int width, int height, double horizontal_angle_rad) {
  require(horizontal_angle_rad > 0.0 && horizontal_angle_rad < std::numbers::pi,
          "horizontal_angle_rad", horizontal_angle_rad, "must be in (0, pi)");
  const double focal_px = 0.5 * width / std::tan(0.5 * horizontal_angle_rad);
  PinholeView view{.fx_px = focal_px,
                   .fy_px = focal_px,
                   .cx_px = 0.5 * (width - 1),
                   .cy_px = 0.5 * (height - 1),
                   .width = width,
                   .height = height};
  view.validate();
  return view;
}

PinholeView PinholeView::divided(int n) const {
  // Part i of pixel u is pixel n u + i, with its centre at u + (i + 1/2) / n - 1/2.
  const auto place = [n](double pixel) { return n * pixel + 0.5 * (n - 1); };
  return {n * fx_px, n * fy_px, place(cx_px), place(cy_px), n * width, n * height, distortion};
}

PinholeView PinholeView::ideal() const {
  PinholeView view = *this;
  view.distortion.reset();
  return view;
}

Eigen::Vector3d PinholeView::ray(int row, int column) const {
  return at_unit_z(*this, row, column).normalized();
}

double PinholeView::radial_per_z(int row, int column) const {
  return at_unit_z(*this, row, column).norm();
}

std::optional<Eigen::Vector2d> PinholeView::pixel_of(const Eigen::Vector3d& point) const {
  if (!(point.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d ideal = point.head<2>() / point.z();
  Eigen::Vector2d place = ideal;
  if (distortion) {
    place = distortion->distort(ideal);
    // Beyond the fold, positions belong to other rays.
    const auto back = distortion->undistort(place);
    if (!back || !((*back - ideal).norm() <= 1e-6 * (1.0 + ideal.norm()))) return std::nullopt;
  }
  return Eigen::Vector2d(fx_px * place.x() + cx_px, fy_px * place.y() + cy_px);
}

void PinholeView::validate() const {
  require(width > 0, "width", width, "must be > 0");
  require(height > 0, "height", height, "must be > 0");
  require(std::isfinite(fx_px) && fx_px > 0.0, "fx_px", fx_px, "must be finite and > 0");
  require(std::isfinite(fy_px) && fy_px > 0.0, "fy_px", fy_px, "must be finite and > 0");
  require(std::isfinite(cx_px), "cx_px", cx_px, "must be finite");
  require(std::isfinite(cy_px), "cy_px", cy_px, "must be finite");
  if (!distortion) return;
  distortion->validate("lens.distortion");
  check_no_fold(*this);
}

PixelRays::PixelRays(PinholeView view) : view_(std::move(view)) {
  view_.validate();
  if (!view_.distortion) return;
  const auto width = static_cast<std::size_t>(view_.width);
  slopes_.resize(static_cast<std::size_t>(view_.height) * width);
  parallel_for(view_.height, [&](std::int64_t row) {
    for (int column = 0; column < view_.width; ++column)
      slopes_[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] =
          tofsmith::at_unit_z(view_, static_cast<int>(row), column).head<2>();
  });
}

PixelRays::PixelRays(PinholeView view, std::vector<Eigen::Vector2d> slopes)
    : view_(std::move(view)), slopes_(std::move(slopes)) {
  view_.validate();
  require(std::ssize(slopes_) == std::int64_t{view_.width} * view_.height, "number of rays",
          slopes_.size(), "must be one for each pixel");
}

Eigen::Vector3d PixelRays::at_unit_z(int row, int column) const {
  if (slopes_.empty()) return tofsmith::at_unit_z(view_, row, column);
  const Eigen::Vector2d& slope =
      slopes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
              static_cast<std::size_t>(column)];
  return {slope.x(), slope.y(), 1.0};
}

Eigen::Vector3d PixelRays::ray(int row, int column) const {
  return at_unit_z(row, column).normalized();
}

double PixelRays::radial_per_z(int row, int column) const { return at_unit_z(row, column).norm(); }

Image<float> radial_from_z(const Image<float>& z_m, const PinholeView& view) {
  return radial_from_z(z_m, PixelRays(view));
}

Image<float> radial_from_z(const Image<float>& z_m, const PixelRays& rays) {
  return scaled(z_m, rays, [](double radial_per_z) { return radial_per_z; });
}

Image<float> z_from_radial(const Image<float>& radial_m, const PinholeView& view) {
  return z_from_radial(radial_m, PixelRays(view));
}

Image<float> z_from_radial(const Image<float>& radial_m, const PixelRays& rays) {
  return scaled(radial_m, rays, [](double radial_per_z) { return 1.0 / radial_per_z; });
}

}  // namespace tofsmith

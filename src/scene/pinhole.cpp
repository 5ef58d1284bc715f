// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

template <typename Scale>
Image<float> scaled(const Image<float>& image, const PinholeView& view, Scale&& scale) {
  view.validate();
  require(image.height == view.height && image.width == view.width, "image size",
          fmt::format("{} x {}", image.height, image.width),
          fmt::format("must equal the view's, {} x {}", view.height, view.width));
  Image<float> result = image;
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column)
      result(row, column) = static_cast<float>(image(row, column) * scale(row, column));
  return result;
}

/// The point of a pixel's ray at z = 1.
Eigen::Vector3d at_unit_z(const PinholeView& view, int row, int column) {
  return {(column - view.cx_px) / view.fx_px, (row - view.cy_px) / view.fy_px, 1.0};
}

}  // namespace

PinholeView PinholeView::centred(int width, int height, double horizontal_angle_rad) {
  require(horizontal_angle_rad > 0.0 && horizontal_angle_rad < std::numbers::pi,
          "horizontal_angle_rad", horizontal_angle_rad, "must be in (0, pi)");
  const double focal_px = 0.5 * width / std::tan(0.5 * horizontal_angle_rad);
  const PinholeView view{.fx_px = focal_px,
                         .fy_px = focal_px,
                         .cx_px = 0.5 * (width - 1),
                         .cy_px = 0.5 * (height - 1),
                         .width = width,
                         .height = height};
  view.validate();
  return view;
}

PinholeView PinholeView::divided(int n) const {
  // Part i of pixel u has its centre at u + (i + 1/2) / n - 1/2, and is pixel n u + i.
  const auto place = [n](double pixel) { return n * pixel + 0.5 * (n - 1); };
  return {n * fx_px, n * fy_px, place(cx_px), place(cy_px), n * width, n * height};
}

Eigen::Vector3d PinholeView::ray(int row, int column) const {
  return at_unit_z(*this, row, column).normalized();
}

double PinholeView::radial_per_z(int row, int column) const {
  return at_unit_z(*this, row, column).norm();
}

void PinholeView::validate() const {
  require(width > 0, "width", width, "must be > 0");
  require(height > 0, "height", height, "must be > 0");
  require(std::isfinite(fx_px) && fx_px > 0.0, "fx_px", fx_px, "must be finite and > 0");
  require(std::isfinite(fy_px) && fy_px > 0.0, "fy_px", fy_px, "must be finite and > 0");
  require(std::isfinite(cx_px), "cx_px", cx_px, "must be finite");
  require(std::isfinite(cy_px), "cy_px", cy_px, "must be finite");
}

Image<float> radial_from_z(const Image<float>& z_m, const PinholeView& view) {
  return scaled(z_m, view, [&](int row, int column) { return view.radial_per_z(row, column); });
}

Image<float> z_from_radial(const Image<float>& radial_m, const PinholeView& view) {
  return scaled(radial_m, view,
                [&](int row, int column) { return 1.0 / view.radial_per_z(row, column); });
}

}  // namespace tofsmith

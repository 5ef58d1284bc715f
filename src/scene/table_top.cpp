// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/table_top.hpp"

#include <numbers>

namespace tofsmith {

namespace {

// World axes: x right, y down, z away from the camera; the table's top is y = 0.
constexpr double first_book_z_m = 1.7;
constexpr double wall_z_m = first_book_z_m + 2.0;

Shape book(double x_m, double z_m, double turn_rad, const Texture& cover) {
  const Eigen::Vector3d size_m(0.34, 0.48, 0.06);  // width, height, thickness
  return Box{.centre = {x_m, -0.5 * size_m.y(), z_m + 0.5 * size_m.z()},
             .size_m = size_m,
             .rotation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix(),
             .texture = cover};
}

}  // namespace

StagedScene table_top_scene(int width, int height) {
  using Pattern = Texture::Pattern;
  StagedScene scene;
  scene.shapes = {
      Box{.centre = {0.0, 0.03, 1.6},
          .size_m = {2.6, 0.06, 2.4},
          .texture = {Pattern::stripes, 0.55, 0.45, 0.12}},
      Plane{.point = {0.0, 0.0, wall_z_m},
            .normal = {0.0, 0.0, -1.0},
            .texture = {Pattern::checker, 0.80, 0.65, 0.50}},
      book(-0.62, first_book_z_m, 0.10, {Pattern::uniform, 0.10, 0.10, 0.1}),
      book(-0.14, first_book_z_m + 0.2, -0.08, {Pattern::stripes, 0.70, 0.50, 0.07}),
      book(0.35, first_book_z_m + 0.4, 0.06, {Pattern::checker, 0.90, 0.60, 0.06}),
      Sphere{.centre = {0.45, -0.20, 1.25},
             .radius_m = 0.20,
             .texture = {Pattern::checker, 0.95, 0.60, 0.20 * std::numbers::pi / 6}},
  };
  scene.view = PinholeView::centred(width, height, std::numbers::pi / 3);
  scene.camera_to_world =
      Eigen::Translation3d(0.0, -0.55, 0.0) * Eigen::AngleAxisd(-0.20, Eigen::Vector3d::UnitX());
  return scene;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/built_in_scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

namespace {

using Pattern = Texture::Pattern;

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

/// Returns the demo scene, after the paper: three upright books on a table, 20 cm apart in depth; a
/// wall 2 m behind the first book; a ball of radius 20 cm about 1.2 m away. Distances are about 1
/// to 4 m.
/// @param width, height  > 0; the view is 60 degrees wide
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 6
StagedScene table_top_scene(int width, int height) {
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

struct Finger {
  Eigen::Vector3d knuckle;
  double spread_rad;                  ///< angle from the middle of the hand, towards +x
  std::array<double, 3> phalanges_m;  ///< lengths, from the knuckle
  double radius_m;                    ///< at the knuckle; tapers
  std::array<double, 3> curl_rad;     ///< of each joint, towards the palm
};

// Adult hand, rounded to millimetres.
const std::array<Finger, 4> fingers = {{
    {{-0.033, 0.083, 0.000}, -0.13, {0.041, 0.025, 0.019}, 0.0100, {0.10, 0.16, 0.12}},
    {{-0.010, 0.089, -0.002}, -0.02, {0.044, 0.029, 0.020}, 0.0102, {0.08, 0.12, 0.10}},
    {{0.012, 0.085, -0.001}, 0.09, {0.041, 0.027, 0.019}, 0.0097, {0.12, 0.16, 0.12}},
    {{0.032, 0.075, 0.002}, 0.22, {0.033, 0.020, 0.018}, 0.0086, {0.16, 0.20, 0.14}},
}};

class HandBuilder {
 public:
  HandBuilder(const Eigen::Isometry3d& to_world, const Texture& skin)
      : to_world_(to_world), skin_(skin) {}

  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double radius_m) {
    shapes_.push_back(Capsule{to_world_ * start, to_world_ * end, radius_m, skin_});
  }

  void add_finger(const Finger& finger) {
    Eigen::Vector3d joint = finger.knuckle;
    double curl_rad = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      curl_rad += finger.curl_rad[i];
      const Eigen::Vector3d along(std::sin(finger.spread_rad) * std::cos(curl_rad),
                                  std::cos(finger.spread_rad) * std::cos(curl_rad),
                                  std::sin(curl_rad));
      const Eigen::Vector3d next = joint + finger.phalanges_m[i] * along;
      add(joint, next, finger.radius_m * (1.0 - 0.07 * static_cast<double>(i)));
      joint = next;
    }
  }

  void add_palm() {
    // Bones from the wrist to the knuckles and between them.
    constexpr int fan = 9;
    for (int i = 0; i < fan; ++i) {
      const double place = 3.0 * i / (fan - 1);
      const auto left = static_cast<std::size_t>(std::min(2.0, place));
      const double share = place - static_cast<double>(left);
      const Eigen::Vector3d knuckle =
          (1 - share) * fingers[left].knuckle + share * fingers[left + 1].knuckle;
      add({0.55 * knuckle.x(), 0.008, -0.002}, knuckle - Eigen::Vector3d(0, 0.004, 0.001), 0.0112);
    }
    add({-0.017, 0.018, 0.002}, {-0.030, 0.050, 0.004}, 0.0160);  // ball of the thumb
    add({0.018, 0.014, 0.000}, {0.029, 0.052, 0.001}, 0.0138);    // heel of the hand
  }

  void add_thumb() {
    const std::array<Eigen::Vector3d, 4> joints = {{{-0.020, 0.018, 0.004},
                                                    {-0.050, 0.050, 0.009},
                                                    {-0.072, 0.078, 0.011},
                                                    {-0.083, 0.102, 0.010}}};
    const std::array<double, 3> radii_m = {0.0135, 0.0112, 0.0102};
    for (std::size_t i = 0; i < 3; ++i) add(joints[i], joints[i + 1], radii_m[i]);
    for (const double share : {0.35, 0.7})  // web to the index finger
      add(joints[0] + share * (joints[1] - joints[0]), {-0.033, 0.045 + 0.025 * share, 0.000},
          0.0095);
    add({-0.048, 0.055, 0.006}, {-0.034, 0.068, 0.000}, 0.0080);
  }

  void add_forearm() {
    for (const double side : {-1.0, 0.0, 1.0}) {
      add({0.012 * side, 0.014, -0.003}, {0.012 * side, -0.030, -0.004}, 0.0165);
      add({0.012 * side, -0.020, -0.004}, {0.020 * side, -0.150, -0.006}, 0.0185);
    }
  }

  std::vector<Shape> take() { return std::move(shapes_); }

 private:
  const Eigen::Isometry3d& to_world_;
  const Texture& skin_;
  std::vector<Shape> shapes_;
};

/// Returns an open right hand with its forearm, made of capsules. Axes from the wrist: x towards
/// the little finger, y towards the finger tips, z out of the palm.
std::vector<Shape> open_hand(const Eigen::Isometry3d& hand_to_world, const Texture& skin) {
  HandBuilder hand(hand_to_world, skin);
  hand.add_palm();
  for (const Finger& finger : fingers) hand.add_finger(finger);
  hand.add_thumb();
  hand.add_forearm();
  return hand.take();
}

constexpr double degrees = std::numbers::pi / 180;

Texture uniform(double albedo) { return {.albedo = albedo}; }
Texture pattern(Pattern kind, double albedo, double other_albedo, double period_m) {
  return {.pattern = kind, .albedo = albedo, .other_albedo = other_albedo, .period_m = period_m};
}

Shape wall_at(double z_m, const Texture& texture) {
  return Plane{.point = {0, 0, z_m}, .normal = {0, 0, -1}, .texture = texture};
}

StagedScene books(int width, int height) {
  constexpr double table_y_m = 0.22;
  const auto book = [](double x_m, double front_z_m, const Texture& cover) {
    const Eigen::Vector3d size_m(0.24, 0.34, 0.04);  // width, height, thickness
    return Box{.centre = {x_m, table_y_m - 0.5 * size_m.y(), front_z_m + 0.5 * size_m.z()},
               .size_m = size_m,
               .texture = cover};
  };
  return {.shapes = {book(-0.30, 1.2, uniform(0.10)),
                     book(0.00, 1.4, pattern(Pattern::stripes, 0.70, 0.50, 0.06)),
                     book(0.34, 1.6, pattern(Pattern::checker, 0.90, 0.60, 0.06)),
                     wall_at(3.2, uniform(0.75)),
                     Box{.centre = {0.0, table_y_m + 0.02, 1.2},
                         .size_m = {2.6, 0.04, 1.6},
                         .texture = uniform(0.45)}},
          .view = PinholeView::centred(width, height, 42 * degrees)};
}

/// Six groups of three strips, one group around each half-axis.
double panel_albedo(const Eigen::Vector3d& direction) {
  constexpr std::array<double, 3> strips = {0.85, 0.45, 0.70};
  constexpr double seam_albedo = 0.20, seam_width = 0.035;
  Eigen::Index axis = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  const double across = direction[(axis + 1) % 3] / largest;
  const double along = direction[(axis + 2) % 3] / largest;
  const double strip = 1.5 * (across + 1);
  const bool on_seam =
      std::abs(strip - std::round(strip)) < 1.5 * seam_width || 1 - std::abs(along) < seam_width;
  return on_seam ? seam_albedo : strips[static_cast<std::size_t>(std::min(2.0, strip))];
}

Texture volleyball(double radius_m) {
  Texture texture{.pattern = Pattern::image,
                  .albedo = 1.0,
                  .period_m = 2 * std::numbers::pi * radius_m,
                  .image = Image<float>(512, 1024)};
  Image<float>& image = texture.image;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(25 * degrees, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(35 * degrees, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      // Rows run opposite to the second coordinate, the latitude.
      const double longitude_rad = 2 * std::numbers::pi * (column + 0.5) / image.width;
      double latitude_rad = -std::numbers::pi * (row + 0.5) / image.height;
      if (latitude_rad < -0.5 * std::numbers::pi) latitude_rad += std::numbers::pi;
      const double equator = std::cos(latitude_rad);
      image(row, column) = static_cast<float>(panel_albedo(
          turn * Eigen::Vector3d(equator * std::sin(longitude_rad), std::sin(latitude_rad),
                                 equator * std::cos(longitude_rad))));
    }
  return texture;
}

StagedScene ball(int width, int height) {
  constexpr double radius_m = 0.20;
  return {
      .shapes = {Sphere{.centre = {0, 0, 1}, .radius_m = radius_m, .texture = volleyball(radius_m)},
                 wall_at(2.5, uniform(0.60))},
      .view = PinholeView::centred(width, height, 38 * degrees)};
}

StagedScene wall(int width, int height) {
  return {.shapes = {wall_at(0.5, uniform(0.80))},
          .view = PinholeView::centred(width, height, 40 * degrees)};
}

StagedScene corner(int width, int height) {
  const auto half = [](double side) {
    return Plane{.point = {0, 0, 3}, .normal = {side, 0, -1}, .texture = uniform(0.70)};
  };
  return {.shapes = {half(1), half(-1)}, .view = PinholeView::centred(width, height, 70 * degrees)};
}

StagedScene room(int width, int height) {
  StagedScene scene = corner(width, height);
  scene.shapes.emplace_back(
      Plane{.point = {0, 1, 0}, .normal = {0, -1, 0}, .texture = uniform(0.40)});
  return scene;
}

StagedScene hand(int width, int height) {
  // The hand's y axis points up, the camera's down.
  Eigen::Isometry3d hand_to_world = Eigen::Isometry3d::Identity();
  hand_to_world.translate(Eigen::Vector3d(0.012, 0.075, 0.50));
  hand_to_world.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  hand_to_world.rotate(Eigen::AngleAxisd(8 * degrees, Eigen::Vector3d::UnitY()));
  hand_to_world.rotate(Eigen::AngleAxisd(-8 * degrees, Eigen::Vector3d::UnitX()));
  return {.shapes = open_hand(hand_to_world, uniform(0.60)),
          .view = PinholeView::centred(width, height, 36 * degrees)};
}

/// For frames of some milliseconds; the hand stays in view for at least 0.1 s.
StagedScene moving_hand(int width, int height) {
  StagedScene scene = hand(width, height);
  for (Shape& shape : scene.shapes)
    shape = moved(shape, Eigen::Isometry3d(Eigen::Translation3d(-0.08, 0.0, 0.0)));
  const Motion motion{.velocity_m_per_s = {1.0, 0.0, 0.0}};
  scene.shape_motions.assign(scene.shapes.size(), motion);
  scene.shapes.emplace_back(wall_at(1.0, uniform(0.75)));
  scene.shape_motions.emplace_back();
  return scene;
}

struct Entry {
  std::string_view name;
  StagedScene (*stage)(int width, int height);
};
constexpr std::array<Entry, 8> entries = {{{"table-top", table_top_scene},
                                           {"books", books},
                                           {"ball", ball},
                                           {"wall", wall},
                                           {"corner", corner},
                                           {"room", room},
                                           {"hand", hand},
                                           {"moving-hand", moving_hand}}};

}  // namespace

std::vector<std::string> built_in_scene_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return names;
}

StagedScene built_in_scene(std::string_view name, int width, int height) {
  for (const Entry& entry : entries)
    if (entry.name == name) return entry.stage(width, height);
  const std::vector<std::string> names = built_in_scene_names();
  std::string rule = "must be one of";
  for (const std::string& known : names) rule += " " + known;
  const std::string meant = nearest_word(name, names);
  if (!meant.empty()) rule += "; did you mean " + meant + "?";
  reject("scene", name, rule);
}

}  // namespace tofsmith

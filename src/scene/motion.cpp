// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith {

namespace {

void move(Plane& plane, const Eigen::Isometry3d& motion) {
  plane.point = motion * plane.point;
  plane.normal = motion.linear() * plane.normal;
}
void move(Box& box, const Eigen::Isometry3d& motion) {
  box.centre = motion * box.centre;
  box.rotation = motion.linear() * box.rotation;
}
void move(Sphere& sphere, const Eigen::Isometry3d& motion) {
  sphere.centre = motion * sphere.centre;
}
void move(Capsule& capsule, const Eigen::Isometry3d& motion) {
  capsule.start = motion * capsule.start;
  capsule.end = motion * capsule.end;
}
void move(Mesh& mesh, const Eigen::Isometry3d& motion) {
  mesh.mesh_to_world = motion * mesh.mesh_to_world;
}

}  // namespace

Eigen::Isometry3d Motion::at(double time_s) const {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const double rate_rad_per_s = turn_rad_per_s.norm();
  if (rate_rad_per_s > 0.0)
    motion.linear() = Eigen::AngleAxisd(rate_rad_per_s * time_s, turn_rad_per_s / rate_rad_per_s)
                          .toRotationMatrix();
  motion.translation() =
      turn_centre_m + velocity_m_per_s * time_s - motion.linear() * turn_centre_m;
  return motion;
}

void Motion::validate(std::string_view field) const {
  const std::string name(field);
  require(velocity_m_per_s.allFinite(), name + ".velocity_m_per_s", velocity_m_per_s.transpose(),
          "must be finite");
  require(turn_rad_per_s.allFinite(), name + ".turn_rad_per_s", turn_rad_per_s.transpose(),
          "must be finite");
  require(turn_centre_m.allFinite(), name + ".turn_centre_m", turn_centre_m.transpose(),
          "must be finite");
}

Shape moved(const Shape& shape, const Eigen::Isometry3d& motion) {
  Shape result = shape;
  std::visit([&](auto& s) { move(s, motion); }, result);
  return result;
}

bool StagedScene::shapes_are_still() const {
  return std::all_of(shape_motions.begin(), shape_motions.end(),
                     [](const Motion& motion) { return motion.is_still(); });
}

bool StagedScene::is_still() const { return camera_motion.is_still() && shapes_are_still(); }

StagedScene StagedScene::at(double time_s) const {
  camera_motion.validate("camera_motion");
  require(shape_motions.empty() || shape_motions.size() == shapes.size(), "shape_motions",
          shape_motions.size(),
          fmt::format("must be none, or one for each of the {} shapes", shapes.size()));
  StagedScene scene{.shapes = {}, .view = view, .camera_to_world = camera_to_world};
  if (!camera_motion.is_still()) scene.camera_to_world = camera_motion.at(time_s) * camera_to_world;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Motion motion = shape_motions.empty() ? Motion() : shape_motions[i];
    motion.validate("shape_motions");
    scene.shapes.push_back(motion.is_still() ? shapes[i] : moved(shapes[i], motion.at(time_s)));
  }
  return scene;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "scene/rigid.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Unit vectors perpendicular to `normal`.
std::pair<Eigen::Vector3d, Eigen::Vector3d> axes_across(const Eigen::Vector3d& normal) {
  Eigen::Index smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Eigen::Vector3d first = normal.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  return {first, normal.cross(first)};
}

void require_finite(const Eigen::Vector3d& point, std::string_view field) {
  require(point.allFinite(), field, point.transpose(), "must be finite");
}

void validate_shape(const Plane& plane) {
  require_finite(plane.point, "plane.point");
  require_finite(plane.normal, "plane.normal");
  require(plane.normal.norm() > 0.0, "plane.normal", plane.normal.transpose(), "must not be zero");
}

void validate_shape(const Box& box) {
  require_finite(box.centre, "box.centre");
  require_finite(box.size_m, "box.size_m");
  require(box.size_m.minCoeff() > 0.0, "box.size_m", box.size_m.transpose(), "must be > 0");
  const double skew =
      (box.rotation.transpose() * box.rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require(skew < 1e-6, "box.rotation", skew, "must have orthonormal columns (deviation shown)");
}

void validate_shape(const Sphere& sphere) {
  require_finite(sphere.centre, "sphere.centre");
  require(std::isfinite(sphere.radius_m) && sphere.radius_m > 0.0, "sphere.radius_m",
          sphere.radius_m, "must be finite and > 0");
}

void validate_shape(const Mesh& mesh) {
  mesh.triangles.validate();
  require(std::isfinite(mesh.scale_m) && mesh.scale_m > 0.0, "mesh.scale_m", mesh.scale_m,
          "must be finite and > 0");
  require_rigid(mesh.mesh_to_world, "mesh.mesh_to_world");
  double reach_m = mesh.mesh_to_world.translation().norm();
  for (const Eigen::Vector3d& vertex : mesh.triangles.vertices)
    reach_m = std::max(reach_m, mesh.scale_m * vertex.norm());
  require(reach_m <= 1e12, "mesh.vertices", reach_m,
          "must be within 1e12 m of the world's origin (distance shown)");
}

void validate_shape(const Capsule& capsule) {
  require_finite(capsule.start, "capsule.start");
  require_finite(capsule.end, "capsule.end");
  require(std::isfinite(capsule.radius_m) && capsule.radius_m > 0.0, "capsule.radius_m",
          capsule.radius_m, "must be finite and > 0");
}

}  // namespace

double Texture::at(double first_m, double second_m) const {
  if (pattern == Pattern::uniform) return albedo;
  if (pattern == Pattern::image) {
    const double height_m = period_m * image.height / image.width;
    return image_at(first_m / period_m, second_m / height_m);
  }
  double field = std::floor(first_m / period_m);
  if (pattern == Pattern::checker) field += std::floor(second_m / period_m);
  return std::fmod(std::abs(field), 2.0) == 0.0 ? albedo : other_albedo;
}

double Texture::image_at(double u, double v) const {
  const auto pixel = [](double position, int count) {
    const double share = position - std::floor(position);
    return share >= 0.0 ? std::min(count - 1, static_cast<int>(share * count)) : 0;  // 0 for NaN
  };
  return albedo * image(pixel(-v, image.height), pixel(u, image.width));
}

void Texture::validate() const {
  for (const double value : {albedo, other_albedo})
    require(value >= 0.0 && value <= 1.0, "texture.albedo", value, "must be in [0, 1]");
  require(std::isfinite(period_m) && period_m > 0.0, "texture.period_m", period_m,
          "must be finite and > 0");
  if (pattern != Pattern::image) return;
  require(!image.empty(), "texture.image", "no pixels", "must have pixels");
  for (const float value : image.pixels)
    require(value >= 0.0f && value <= 1.0f, "texture.image", value, "must be in [0, 1]");
}

std::optional<Hit> intersect(const Plane& plane, const Ray& ray) {
  const Eigen::Vector3d normal = plane.normal.normalized();
  const double distance_m =
      normal.dot(plane.point - ray.origin) / normal.dot(ray.direction);  // +-inf, NaN if parallel
  if (!(distance_m > 0.0) || !std::isfinite(distance_m)) return std::nullopt;
  const auto [first, second] = axes_across(normal);
  const Eigen::Vector3d on_plane = ray.origin + distance_m * ray.direction - plane.point;
  return Hit{distance_m, normal, plane.texture.at(first.dot(on_plane), second.dot(on_plane))};
}

std::optional<Hit> intersect(const Box& box, const Ray& ray) {
  const Eigen::Vector3d origin = box.rotation.transpose() * (ray.origin - box.centre);
  const Eigen::Vector3d direction = box.rotation.transpose() * ray.direction;
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  Eigen::Index enter_axis = 0, leave_axis = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * box.size_m[axis];
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half) return std::nullopt;
      continue;
    }
    double near = (-half - origin[axis]) / direction[axis];
    double far = (half - origin[axis]) / direction[axis];
    if (near > far) std::swap(near, far);
    if (near > enter) std::tie(enter, enter_axis) = std::pair(near, axis);
    if (far < leave) std::tie(leave, leave_axis) = std::pair(far, axis);
  }
  if (enter > leave || leave <= 0.0) return std::nullopt;
  const bool inside = enter <= 0.0;
  const double distance_m = inside ? leave : enter;
  const Eigen::Index axis = inside ? leave_axis : enter_axis;
  const Eigen::Vector3d on_box = origin + distance_m * direction + 0.5 * box.size_m;
  return Hit{distance_m, box.rotation.col(axis),
             box.texture.at(on_box[(axis + 1) % 3], on_box[(axis + 2) % 3])};
}

std::optional<Hit> intersect(const Sphere& sphere, const Ray& ray) {
  const Eigen::Vector3d to_centre = sphere.centre - ray.origin;
  const double along = to_centre.dot(ray.direction);
  // A cross product avoids cancellation for far spheres.
  const double aside = to_centre.cross(ray.direction).norm();
  if (aside > sphere.radius_m) return std::nullopt;
  const double half_chord =
      std::sqrt(std::max(0.0, (sphere.radius_m - aside) * (sphere.radius_m + aside)));
  const double distance_m = along - half_chord > 0.0 ? along - half_chord : along + half_chord;
  if (distance_m <= 0.0) return std::nullopt;
  const Eigen::Vector3d normal =
      (ray.origin + distance_m * ray.direction - sphere.centre) / sphere.radius_m;
  const double longitude_rad = std::atan2(normal.x(), normal.z());
  const double latitude_rad = std::asin(std::clamp(normal.y(), -1.0, 1.0));
  return Hit{distance_m, normal,
             sphere.texture.at(sphere.radius_m * longitude_rad, sphere.radius_m * latitude_rad)};
}

void validate(const Shape& shape) {
  std::visit(
      [](const auto& s) {
        validate_shape(s);
        s.texture.validate();
      },
      shape);
}

namespace {

/// Smallest root above `lowest` of (t + b)^2 = discriminant.
std::optional<double> nearest_root(double b, double discriminant, double lowest) {
  if (discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  for (const double t : {-b - root, -b + root})
    if (t > lowest) return t;
  return std::nullopt;
}

}  // namespace

std::optional<Hit> intersect(const Capsule& capsule, const Ray& ray) {
  const Eigen::Vector3d span = capsule.end - capsule.start;
  const double length_m = span.norm();
  const Eigen::Vector3d axis =
      length_m > 0.0 ? Eigen::Vector3d(span / length_m) : Eigen::Vector3d::UnitY();
  std::optional<double> nearest;
  const auto along = [&](double t) {
    return axis.dot(ray.origin + t * ray.direction - capsule.start);
  };
  // Accept a hit only on its part: the side between the ends, a cap beyond.
  const auto try_part = [&](double b, double discriminant, auto&& belongs) {
    double lowest = 0.0;
    while (const auto t = nearest_root(b, discriminant, lowest)) {
      if (belongs(along(*t))) {
        if (!nearest || *t < *nearest) nearest = t;
        return;
      }
      lowest = *t;
    }
  };

  const Eigen::Vector3d offset = ray.origin - capsule.start;
  const Eigen::Vector3d across = ray.direction - axis.dot(ray.direction) * axis;
  const Eigen::Vector3d aside = offset - axis.dot(offset) * axis;
  const double a = across.squaredNorm();
  if (a > 1e-24) {
    const double b = across.dot(aside) / a;
    const double missed_m = (aside - b * across).norm();
    try_part(b, (capsule.radius_m - missed_m) * (capsule.radius_m + missed_m) / a,
             [&](double at) { return at >= 0.0 && at <= length_m; });
  }
  for (const bool far_end : {false, true}) {
    const Eigen::Vector3d from = ray.origin - (far_end ? capsule.end : capsule.start);
    const double b = from.dot(ray.direction);
    const double missed_m = from.cross(ray.direction).norm();
    try_part(b, (capsule.radius_m - missed_m) * (capsule.radius_m + missed_m),
             [&](double at) { return far_end ? at >= length_m : at <= 0.0; });
  }
  if (!nearest) return std::nullopt;

  const Eigen::Vector3d point = ray.origin + *nearest * ray.direction;
  const double at = along(*nearest);
  const Eigen::Vector3d foot = capsule.start + std::clamp(at, 0.0, length_m) * axis;
  const Eigen::Vector3d normal = (point - foot) / capsule.radius_m;
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const double angle_rad = std::atan2(normal.dot(axis.cross(first)), normal.dot(first));
  return Hit{*nearest, normal, capsule.texture.at(capsule.radius_m * angle_rad, at)};
}

}  // namespace tofsmith

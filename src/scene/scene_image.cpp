// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/shared/mesh_surface.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

template <typename Rule>
void require_plane(const Image<float>& plane, const SceneImage& scene, std::string_view field,
                   std::string_view rule, Rule&& holds) {
  const auto pixels =
      static_cast<std::size_t>(scene.height()) * static_cast<std::size_t>(scene.width());
  require(plane.height == scene.height() && plane.width == scene.width() && plane.size() == pixels,
          fmt::format("{} size", field),
          fmt::format("{} x {} with {} pixels", plane.height, plane.width, plane.size()),
          fmt::format("must equal depth_m's, {} x {}", scene.height(), scene.width()));
  for (int row = 0; row < plane.height; ++row)
    for (int column = 0; column < plane.width; ++column)
      if (!holds(plane(row, column)))
        reject(fmt::format("{}({}, {})", field, row, column), fmt::format("{}", plane(row, column)),
               rule);
}

}  // namespace

SceneImage::SceneImage(int height, int width)
    : depth_m(height, width, std::numeric_limits<float>::quiet_NaN()),
      albedo(height, width, 1.0f),
      cosine(height, width, 1.0f) {}

void SceneImage::validate() const {
  require(height() > 0 && width() > 0, "depth_m size", fmt::format("{} x {}", height(), width()),
          "must have at least one pixel");
  require_plane(depth_m, *this, "depth_m",
                "must be finite and > 0, or NaN for pixels without return",
                [](float v) { return std::isnan(v) || (std::isfinite(v) && v > 0.0f); });
  const auto is_share = [](float v) { return v >= 0.0f && v <= 1.0f; };
  require_plane(albedo, *this, "albedo", "must be in [0, 1]", is_share);
  require_plane(cosine, *this, "cosine", "must be in [0, 1]", is_share);
  if (!ambient_scale.empty())
    require_plane(ambient_scale, *this, "ambient_scale", "must be finite and >= 0",
                  [](float v) { return std::isfinite(v) && v >= 0.0f; });
}

namespace {

using Place = std::tuple<double, double, double>;
using Edge = std::pair<Place, Place>;

/// Identifies edges by position, because mesh files may duplicate vertices.
bool is_closed(const TriangleMesh& mesh) {
  const auto place = [&](std::uint32_t index) {
    const Eigen::Vector3d& at = mesh.vertices[index];
    return Place(at.x(), at.y(), at.z());
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& corner : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      Edge edge(place(corner[k]), place(corner[(k + 1) % 3]));
      if (edge.second < edge.first) std::swap(edge.first, edge.second);
      if (edge.first != edge.second) edges.push_back(edge);
    }
  std::sort(edges.begin(), edges.end());
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::upper_bound(begin, edges.end(), *begin);
    if ((end - begin) % 2 != 0) return false;
    begin = end;
  }
  return true;
}

int crossings(const Mesh& mesh, const Ray& ray) {
  int count = 0;
  for (std::size_t i = 0; i < mesh.triangles.triangles.size(); ++i)
    count += hit_triangle(mesh, i, ray).has_value();
  return count;
}

bool holds(const Plane&, const Eigen::Vector3d&) { return false; }

bool holds(const Box& box, const Eigen::Vector3d& point) {
  const Eigen::Vector3d own = box.rotation.transpose() * (point - box.centre);
  return (own.cwiseAbs().array() < 0.5 * box.size_m.array()).all();
}

bool holds(const Sphere& sphere, const Eigen::Vector3d& point) {
  return (point - sphere.centre).norm() < sphere.radius_m;
}

bool holds(const Capsule& capsule, const Eigen::Vector3d& point) {
  const Eigen::Vector3d span = capsule.end - capsule.start;
  const double length_squared = span.squaredNorm();
  const double share = length_squared > 0.0
                           ? std::clamp(span.dot(point - capsule.start) / length_squared, 0.0, 1.0)
                           : 0.0;
  return (point - capsule.start - share * span).norm() < capsule.radius_m;
}

bool holds(const Mesh& mesh, const Eigen::Vector3d& point) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.triangles.vertices)
    bounds.extend(mesh.mesh_to_world * (mesh.scale_m * vertex));
  if (!bounds.contains(point) || !is_closed(mesh.triangles)) return false;
  // Three directions: one that hits an edge is outvoted.
  int votes = 0;
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(0.6131, 0.2417, 0.7520), Eigen::Vector3d(-0.3719, 0.8923, 0.2551),
        Eigen::Vector3d(0.1873, -0.5471, -0.8159)})
    votes += crossings(mesh, {point, direction.normalized()}) % 2;
  return votes >= 2;
}

std::string_view kind_of(const Shape& shape) {
  constexpr std::array<std::string_view, std::variant_size_v<Shape>> kinds = {
      "plane", "box", "sphere", "capsule", "mesh"};
  return kinds[shape.index()];
}

}  // namespace

bool is_inside(const Shape& shape, const Eigen::Vector3d& point) {
  return std::visit([&](const auto& s) { return holds(s, point); }, shape);
}

void require_camera_outside(std::span<const Shape> shapes, const Eigen::Vector3d& camera) {
  for (std::size_t i = 0; i < shapes.size(); ++i)
    require(!is_inside(shapes[i], camera), "camera position", camera.transpose(),
            fmt::format("must not be inside shape {}, a {}: move it outside (use planes for walls "
                        "around the camera)",
                        i, kind_of(shapes[i])));
}

void require_something_in_view(const SceneImage& image) {
  const bool any = std::any_of(image.depth_m.pixels.begin(), image.depth_m.pixels.end(),
                               [](float depth) { return std::isfinite(depth); });
  require(any, "pixels that see a shape", 0,
          "must be at least one: rotate or move the camera, widen its view or move the shapes (x "
          "is right, y down, z forward)");
}

void check_view(const StagedScene& scene, const SceneImage& image) {
  require_camera_outside(scene.shapes, scene.camera_to_world.translation());
  require_something_in_view(image);
}

}  // namespace tofsmith

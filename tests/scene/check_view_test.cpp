// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"
#include "generated_meshes.hpp"

namespace tofsmith {
namespace {

std::string refusal(const StagedScene& scene) {
  try {
    check_view(scene, ray_cast(scene.shapes, scene.view, scene.camera_to_world));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

StagedScene scene_of(std::vector<Shape> shapes) {
  return {.shapes = std::move(shapes), .view = PinholeView::centred(16, 12, 1.0)};
}

Mesh mesh_of(TriangleMesh triangles) {
  Mesh mesh;
  mesh.triangles = std::move(triangles);
  return mesh;
}

TEST(CheckView, ReportsTheSolidThatContainsTheCamera) {
  const Shape wall = Plane{.point = {0, 0, 4}};
  const std::string rule = "camera position = 0 0 0; must not be inside shape ";
  const std::string advice = ": move it outside (use planes for walls around the camera)";
  EXPECT_EQ(refusal(scene_of({wall})), "accepted");
  EXPECT_EQ(refusal(scene_of({wall, Box{}})), rule + "1, a box" + advice);
  EXPECT_EQ(refusal(scene_of({Sphere{}, wall})), rule + "0, a sphere" + advice);
  EXPECT_EQ(refusal(scene_of({wall, wall, Capsule{}})), rule + "2, a capsule" + advice);
  EXPECT_EQ(refusal(scene_of({wall, mesh_of(unit_cube())})), rule + "1, a mesh" + advice);
  StagedScene elsewhere = scene_of({wall, Box{}, mesh_of(unit_cube())});
  elsewhere.camera_to_world.translation().x() = 0.6;
  EXPECT_EQ(refusal(elsewhere), "accepted");
}

TEST(CheckView, RefusesAnEmptyView) {
  const std::string message = refusal(scene_of({Sphere{.centre = {0, 0, -3}}}));
  EXPECT_EQ(message.find("pixels that see a shape = 0; must be at least one: rotate or move"), 0u)
      << message;
  EXPECT_NE(refusal(scene_of({})), "accepted");
}

TEST(CheckView, TheInsideOfAMeshIsThatOfItsSolid) {
  const Mesh cube = mesh_of(unit_cube());
  const Shape box = Box{};
  // Adjacent triangles without shared vertices, as from many readers, bound the same solid.
  Mesh apart;
  for (const auto& corner : cube.triangles.triangles)
    for (const std::uint32_t index : corner)
      apart.triangles.vertices.push_back(cube.triangles.vertices[index]);
  for (std::uint32_t i = 0; i < apart.triangles.vertices.size(); i += 3)
    apart.triangles.triangles.push_back({i, i + 1, i + 2});
  int inside = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    RandomStream random(5, i);
    const Eigen::Vector3d point(1.5 * random.uniform() - 0.75, 1.5 * random.uniform() - 0.75,
                                1.5 * random.uniform() - 0.75);
    inside += is_inside(box, point);
    EXPECT_EQ(is_inside(Shape(cube), point), is_inside(box, point)) << point.transpose();
    EXPECT_EQ(is_inside(Shape(apart), point), is_inside(box, point)) << point.transpose();
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 450);
}

TEST(CheckView, AMeshWithAnOpeningHasNoInside) {
  Mesh open = mesh_of(unit_cube());
  open.triangles.triangles.pop_back();
  EXPECT_FALSE(is_inside(Shape(open), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(is_inside(Shape(Plane{}), Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace tofsmith

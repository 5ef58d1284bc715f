// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "generated_shapes.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith {

namespace {

template <typename Change>
std::string refusal(Change&& change) {
  Mesh mesh;
  mesh.triangles = unit_cube();
  change(mesh);
  try {
    validate(Shape(mesh));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Mesh, ReportsTheFieldTheValueAndTheRule) {
  EXPECT_EQ(refusal([](Mesh&) {}), "accepted");
  EXPECT_EQ(refusal([](Mesh& m) { m.triangles.triangles.clear(); }),
            "mesh.triangles = 0; must be at least one");
  EXPECT_EQ(refusal([](Mesh& m) { m.triangles.vertices[5].y() = NAN; }),
            "mesh.vertices[5] = 0.5 nan 0.5; must be finite");
  EXPECT_EQ(refusal([](Mesh& m) { m.triangles.triangles[3][1] = 8; }),
            "mesh.triangles[3] = 8; must be below 8, the number of vertices");
  EXPECT_EQ(refusal([](Mesh& m) { m.triangles.texture_coordinates.resize(3); }),
            "mesh.texture_coordinates = 3; must be 8, one per vertex");
  EXPECT_EQ(refusal([](Mesh& m) { m.scale_m = 0.0; }), "mesh.scale_m = 0; must be finite and > 0");
  EXPECT_EQ(refusal([](Mesh& m) { m.mesh_to_world.linear() *= 2.0; }),
            "mesh.mesh_to_world.rotation = 3; must have orthonormal columns (deviation shown)");
  EXPECT_EQ(refusal([](Mesh& m) { m.mesh_to_world.linear() *= -1.0; }),
            "mesh.mesh_to_world.rotation = -1; must not mirror (determinant shown)");
  EXPECT_EQ(refusal([](Mesh& m) { m.mesh_to_world.translation().z() = INFINITY; }),
            "mesh.mesh_to_world.translation =   0   0 inf; must be finite");
  EXPECT_EQ(
      refusal([](Mesh& m) { m.triangles.vertices[0] *= 1e100; }),
      "mesh.vertices = 8.66025e+99; must be within 1e12 m of the world's origin (distance shown)");
  EXPECT_EQ(refusal([](Mesh& m) { m.texture.albedo = -0.1; }),
            "texture.albedo = -0.1; must be in [0, 1]");
}

TEST(Mesh, ScaleRotationAndTranslationPlaceItInTheWorld) {
  Mesh mesh;
  mesh.triangles = unit_cube();
  mesh.scale_m = 0.2;
  mesh.mesh_to_world.translate(Eigen::Vector3d(0, 0, 3));
  mesh.mesh_to_world.rotate(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitY()));
  const auto hit = intersect(mesh, {{0, 0.01, 0}, {0, 0, 1}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 3.0 - 0.1 * std::sqrt(2.0), 1e-12);
}

/// 2 x 2 pixels: 0.1 0.2 above 0.3 0.4.
Texture four_fields() {
  Texture texture{.pattern = Texture::Pattern::image, .albedo = 1.0, .image = Image<float>(2, 2)};
  texture.image.pixels = {0.1f, 0.2f, 0.3f, 0.4f};
  return texture;
}

TEST(Texture, ImageIsUprightWithUToTheRightAndVUp) {
  const Texture texture = four_fields();
  EXPECT_FLOAT_EQ(static_cast<float>(texture.image_at(0.25, 0.75)), 0.1f);
  EXPECT_FLOAT_EQ(static_cast<float>(texture.image_at(0.75, 0.75)), 0.2f);
  EXPECT_FLOAT_EQ(static_cast<float>(texture.image_at(0.25, 0.25)), 0.3f);
  EXPECT_FLOAT_EQ(static_cast<float>(texture.image_at(0.75, 0.25)), 0.4f);
  EXPECT_FLOAT_EQ(static_cast<float>(texture.image_at(1.25, -0.25)), 0.1f) << "repeats";
}

TEST(Texture, ExtremeCoordinatesReadAValidPixel) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double place : {infinity, -infinity, std::nan(""), 1e308, -1e308}) {
    const double albedo = four_fields().image_at(place, place);
    EXPECT_TRUE(albedo > 0.0 && albedo < 0.5) << place;
  }
}

TEST(Mesh, MapsTheTextureByItsCoordinates) {
  // A quad in front of the camera with an upright texture: v increases upwards, opposite to y.
  Mesh quad;
  quad.triangles.vertices = {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}};
  quad.triangles.triangles = {{0, 1, 2}, {0, 2, 3}};
  quad.triangles.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  quad.texture = four_fields();
  const auto albedo = [&](double x, double y) {
    const auto hit = intersect(quad, {{x, y, 0}, {0, 0, 1}});
    return hit ? static_cast<float>(hit->albedo) : -1.0f;
  };
  EXPECT_FLOAT_EQ(albedo(-0.5, -0.6), 0.1f) << "top left";
  EXPECT_FLOAT_EQ(albedo(0.5, -0.6), 0.2f);
  EXPECT_FLOAT_EQ(albedo(-0.5, 0.6), 0.3f);
  EXPECT_FLOAT_EQ(albedo(0.5, 0.6), 0.4f);
}

/// The mesh is far from the origin.
TriangleMesh tetrahedron(double size) {
  TriangleMesh mesh;
  for (const auto& corner : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0),
                             Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 3)})
    mesh.vertices.push_back(size * (corner + Eigen::Vector3d(100, -50, 7)));
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  return mesh;
}

TEST(FramedMesh, FillsFourFifthsOfTheImage) {
  for (const double size : {1e-3, 1.0, 1e3})
    for (const auto& [width, height] : {std::pair(320, 240), std::pair(100, 400)}) {
      const StagedScene scene = framed_mesh(tetrahedron(size), 0.5, width, height);
      const Mesh& mesh = std::get<Mesh>(scene.shapes.at(0));
      double filled = 0.0;
      for (const Eigen::Vector3d& vertex : mesh.triangles.vertices) {
        const Eigen::Vector3d at = mesh.mesh_to_world * (mesh.scale_m * vertex);
        EXPECT_GT(at.z(), 0.0);
        filled = std::max({filled, 2.0 * scene.view.fx_px * std::abs(at.x() / at.z()) / width,
                           2.0 * scene.view.fy_px * std::abs(at.y() / at.z()) / height});
      }
      EXPECT_NEAR(filled, 0.8, 1e-6) << size << " " << width;
    }
}

TEST(FramedMesh, ShowsTheMeshUprightFromItsFront) {
  const StagedScene scene = framed_mesh(tetrahedron(1.0), 1.0, 320, 240);
  const Mesh& mesh = std::get<Mesh>(scene.shapes.at(0));
  const auto place = [&](int i) {
    return Eigen::Vector3d(mesh.mesh_to_world * mesh.triangles.vertices[static_cast<size_t>(i)]);
  };
  EXPECT_GT(place(1).x(), place(0).x());
  EXPECT_LT(place(2).y(), place(0).y()) << "the world's y axis goes down";
  EXPECT_LT(place(3).z(), place(0).z()) << "the mesh's z axis comes towards the camera";
}

TEST(FramedMesh, RejectsMeshesWithoutExtent) {
  TriangleMesh point;
  point.vertices = {{1, 2, 3}};
  point.triangles = {{0, 0, 0}};
  EXPECT_THROW(framed_mesh(point, 1.0, 32, 24), std::invalid_argument);
  EXPECT_THROW(framed_mesh(tetrahedron(1.0), 0.0, 32, 24), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith

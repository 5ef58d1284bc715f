// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "generated_meshes.hpp"

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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/scene_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "generated_shapes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

TEST(SceneImage, ReportsThePixelTheValueAndTheRule) {
  const auto message = [](auto change) -> std::string {
    SceneImage scene(3, 4);
    change(scene);
    try {
      scene.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](SceneImage&) {}), "accepted");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo(2, 1) = -0.5f; }),
            "albedo(2, 1) = -0.5; must be in [0, 1]");
  EXPECT_EQ(message([](SceneImage& s) { s.cosine(0, 3) = NAN; }),
            "cosine(0, 3) = nan; must be in [0, 1]");
  EXPECT_EQ(message([](SceneImage& s) { s.depth_m(1, 0) = 0.0f; }),
            "depth_m(1, 0) = 0; must be finite and > 0, or NaN for pixels without return");
  EXPECT_EQ(message([](SceneImage& s) { s.depth_m(1, 0) = INFINITY; }),
            "depth_m(1, 0) = inf; must be finite and > 0, or NaN for pixels without return");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo = Image<float>(3, 5); }),
            "albedo size = 3 x 5 with 15 pixels; must equal depth_m's, 3 x 4");
  EXPECT_EQ(message([](SceneImage& s) { s.albedo.pixels.pop_back(); }),
            "albedo size = 3 x 4 with 11 pixels; must equal depth_m's, 3 x 4");
  EXPECT_EQ(message([](SceneImage& s) { s.ambient_scale = Image<float>(3, 4, -1.0f); }),
            "ambient_scale(0, 0) = -1; must be finite and >= 0");
  EXPECT_EQ(message([](SceneImage& s) { s = SceneImage(); }),
            "depth_m size = 0 x 0; must have at least one pixel");
}

TEST(PinholeView, EdgesOfTheImageSpanTheAngle) {
  const PinholeView view = PinholeView::centred(320, 240, std::numbers::pi / 3);
  const Eigen::Vector3d corner_ray((-0.5 - view.cx_px) / view.fx_px, 0, 1);
  EXPECT_NEAR(std::atan2(-corner_ray.x(), 1.0), std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(view.ray(100, 7).norm(), 1.0, 1e-15);
}

TEST(PinholeView, RadialDistanceAndZDepthAreInverse) {
  const PinholeView view = PinholeView::centred(17, 13, 1.4);
  Image<float> z(13, 17, 2.0f);
  z(3, 4) = NAN;
  const Image<float> radial = radial_from_z(z, view);
  const Image<float> back = z_from_radial(radial, view);
  for (int row = 0; row < 13; ++row) {
    for (int column = 0; column < 17; ++column) {
      if (row == 3 && column == 4) {
        EXPECT_TRUE(std::isnan(radial(row, column)));
        continue;
      }
      EXPECT_NEAR(radial(row, column), 2.0 / view.ray(row, column).z(), 1e-6);
      EXPECT_NEAR(back(row, column), 2.0, 1e-6);
    }
  }
  EXPECT_THROW(radial_from_z(Image<float>(5, 5), view), std::invalid_argument);
  EXPECT_THROW(PinholeView{}.validate(), std::invalid_argument);
}

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

PinholeView distorted(LensDistortion distortion) {
  return {.fx_px = 60.0,
          .fy_px = 62.0,
          .cx_px = 39.0,
          .cy_px = 30.5,
          .width = 80,
          .height = 60,
          .distortion = std::move(distortion)};
}

std::vector<PinholeView> views() {
  return {distorted({DistortionModel::opencv, {-0.2, 0.04, 1e-3, -2e-3, -0.004}}),
          distorted({DistortionModel::fisheye, {0.05, -0.01, 0.004, -0.001}})};
}

TEST(DistortedView, ProjectsAPointToThePixelThatSeesIt) {
  for (const PinholeView& view : views())
    for (int row = 0; row < view.height; row += 7)
      for (int column = 0; column < view.width; column += 7) {
        const auto pixel = view.pixel_of(3.0 * view.ray(row, column));
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x(), column, 1e-6);
        EXPECT_NEAR(pixel->y(), row, 1e-6);
      }
  EXPECT_FALSE(views()[0].pixel_of({0, 0, -1}));
}

TEST(DistortedView, CachedRaysEqualThoseOfTheView) {
  for (const PinholeView& view : views()) {
    const PixelRays rays(view);
    for (int row = 0; row < view.height; row += 5)
      for (int column = 0; column < view.width; column += 5) {
        EXPECT_EQ(rays.ray(row, column), view.ray(row, column));
        EXPECT_EQ(rays.radial_per_z(row, column), view.radial_per_z(row, column));
      }
    EXPECT_GT(rays.bytes(), 0u);
    EXPECT_EQ(PixelRays(view.ideal()).bytes(), 0u);
  }
}

TEST(DistortedView, APlaneGivesCoplanarPoints) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, -1.0).normalized();
  const Eigen::Vector3d point_m(0.0, 0.0, 2.0);
  for (const PinholeView& view : views()) {
    const SceneImage seen = ray_cast(std::vector<Shape>{Plane{point_m, normal, {}}}, view);
    for (int row = 0; row < view.height; ++row)
      for (int column = 0; column < view.width; ++column) {
        const Eigen::Vector3d at_m =
            view.ray(row, column) * static_cast<double>(seen.depth_m(row, column));
        EXPECT_NEAR(normal.dot(at_m - point_m), 0.0, 1e-6);
      }
    // The depth of a plane perpendicular to the axis is constant.
    const SceneImage across =
        ray_cast(std::vector<Shape>{Plane{point_m, -Eigen::Vector3d::UnitZ(), {}}}, view);
    for (const float z_m : z_from_radial(across.depth_m, view).pixels) EXPECT_NEAR(z_m, 2.0, 1e-6);
  }
}

TEST(DistortedView, IsInvalidIfItFoldsBackInsideTheImage) {
  PinholeView view = distorted({DistortionModel::opencv, {-0.6, 0.0, 0.0, 0.0}});
  try {
    view.validate();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "lens.distortion = [-0.6, 0, 0, 0]; must not fold back inside the image: it does so "
              "30.18 px "
              "from the axis, towards pixel (row 0, column 0), which is 49.51 px from the axis");
  }
  view.fx_px = view.fy_px = 120.0;  // a narrower view ends before the fold
  EXPECT_NO_THROW(view.validate());
  view = distorted({DistortionModel::fisheye, {0, 0, 0, 0}});
  view.fx_px = view.fy_px = 25.0;
  EXPECT_THROW(view.validate(), std::invalid_argument);
}

TEST(DistortedView, PartsOfPixelsAreCentredOnThem) {
  for (const PinholeView& view : views()) {
    const PinholeView parts = view.divided(3);
    EXPECT_LE((parts.ray(3 * 20 + 1, 3 * 70 + 1) - view.ray(20, 70)).norm(), 1e-12);
  }
}

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/random.hpp"
#include "table_top_image.hpp"

namespace tofsmith {
namespace {

using Pattern = Texture::Pattern;

Ray random_ray(std::uint64_t item) {
  RandomStream random(7, item);
  const Eigen::Vector3d origin(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  return {3.0 * origin, direction.normalized()};
}

TEST(Plane, DepthIsTheDistanceOverTheCosine) {
  const PinholeView view = PinholeView::centred(31, 21, 1.2);
  const std::vector<Shape> wall = {
      Plane{.point = {5, -3, 2.5}, .normal = {0, 0, 7}, .texture = {.albedo = 0.25}}};
  const SceneImage scene = ray_cast(wall, view);
  scene.validate();
  for (int row = 0; row < 21; ++row) {
    for (int column = 0; column < 31; ++column) {
      const double expected = 2.5 * view.radial_per_z(row, column);
      EXPECT_NEAR(scene.depth_m(row, column), expected, 1e-6 * expected);
      EXPECT_NEAR(scene.cosine(row, column), 2.5 / expected, 1e-6);
      EXPECT_FLOAT_EQ(scene.albedo(row, column), 0.25f);
    }
  }
}

TEST(Plane, BehindOrParallelReturnsNothing) {
  const Plane plane{.point = {0, 0, 1}};
  EXPECT_FALSE(intersect(plane, {{0, 0, 2}, {0, 0, 1}}));
  EXPECT_FALSE(intersect(plane, {{0, 0, 0}, {1, 0, 0}}));
}

TEST(Sphere, HitsAreOnTheSurfaceAndNearest) {
  const Sphere sphere{.centre = {0.3, -0.2, 0.5}, .radius_m = 1.7};
  int hits = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Ray ray = random_ray(i);
    const auto hit = intersect(sphere, ray);
    const double along = (sphere.centre - ray.origin).dot(ray.direction);
    const double aside = (ray.origin + along * ray.direction - sphere.centre).norm();
    const bool outside = (ray.origin - sphere.centre).norm() > 1.7;
    ASSERT_EQ(hit.has_value(), aside < 1.7 && (!outside || along > 0)) << i;
    if (!hit) continue;
    ++hits;
    const Eigen::Vector3d at = ray.origin + hit->distance_m * ray.direction;
    EXPECT_NEAR((at - sphere.centre).norm(), 1.7, 1e-12);
    EXPECT_NEAR((hit->normal - (at - sphere.centre) / 1.7).norm(), 0.0, 1e-12);
    EXPECT_EQ(hit->normal.dot(ray.direction) < 0.0, outside) << "the near side, seen from outside";
  }
  EXPECT_GT(hits, 30);
}

TEST(Sphere, DepthOnTheAxisIsCentreMinusRadius) {
  const auto hit = intersect(Sphere{.centre = {0, 0, 4}, .radius_m = 0.5}, {{0, 0, 0}, {0, 0, 1}});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->distance_m, 3.5);
}

/// Reference: the nearest of six rectangular faces.
double box_distance_by_faces(const Box& box, const Ray& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const Eigen::Vector3d normal = box.rotation.col(axis);
      const auto hit =
          intersect(Plane{box.centre + side * box.size_m[axis] * normal, normal, {}}, ray);
      if (!hit) continue;
      const Eigen::Vector3d at =
          box.rotation.transpose() * (ray.origin + hit->distance_m * ray.direction - box.centre);
      bool on_face = true;
      for (int other = 0; other < 3; ++other)
        if (other != axis) on_face = on_face && std::abs(at[other]) <= 0.5 * box.size_m[other];
      if (on_face) nearest = std::min(nearest, hit->distance_m);
    }
  }
  return nearest;
}

TEST(Box, EqualsTheNearestOfItsSixFaces) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& rotation : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn}) {
    const Box box{.centre = {0.2, 0.1, -0.4}, .size_m = {2.0, 3.0, 1.0}, .rotation = rotation};
    int hits = 0;
    for (std::uint64_t i = 0; i < 600; ++i) {
      const Ray ray = random_ray(i);
      const double expected = box_distance_by_faces(box, ray);
      const auto hit = intersect(box, ray);
      ASSERT_EQ(hit.has_value(), std::isfinite(expected)) << i;
      if (!hit) continue;
      ++hits;
      EXPECT_NEAR(hit->distance_m, expected, 1e-9);
    }
    EXPECT_GT(hits, 30);
  }
}

TEST(RayCast, TheNearestShapeHidesTheOthers) {
  const std::vector<Shape> shapes = {
      Plane{.point = {0, 0, 5}, .texture = {.albedo = 0.1}},
      Box{.centre = {0, 0, 3}, .size_m = {10, 10, 0.5}, .texture = {.albedo = 0.2}},
      Sphere{.centre = {0, 0, 2}, .radius_m = 0.25, .texture = {.albedo = 0.3}}};
  const SceneImage scene = ray_cast(shapes, PinholeView::centred(41, 41, 0.8));
  EXPECT_FLOAT_EQ(scene.albedo(20, 20), 0.3f);
  EXPECT_NEAR(scene.depth_m(20, 20), 1.75, 1e-6);
  EXPECT_FLOAT_EQ(scene.albedo(20, 0), 0.2f);
}

TEST(RayCast, FollowsTheCamerasPose) {
  const std::vector<Shape> ball = {Sphere{.centre = {4, 0, 0}, .radius_m = 1.0}};
  const Eigen::Isometry3d looking_right(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  const PinholeView view = PinholeView::centred(11, 11, 0.3);
  EXPECT_NEAR(ray_cast(ball, view, looking_right).depth_m(5, 5), 3.0, 1e-6);
  EXPECT_TRUE(std::isnan(ray_cast(ball, view).depth_m(5, 5)));
}

TEST(Texture, CheckerAlternatesAlongBothAxesAndStripesAlongOne) {
  const Texture checker{Pattern::checker, 0.2, 0.8, 0.5};
  EXPECT_EQ(checker.at(0.1, 0.1), 0.2);
  EXPECT_EQ(checker.at(0.6, 0.1), 0.8);
  EXPECT_EQ(checker.at(0.1, -0.1), 0.8);
  EXPECT_EQ(checker.at(-0.1, -0.1), 0.2);
  const Texture stripes{Pattern::stripes, 0.2, 0.8, 0.5};
  EXPECT_EQ(stripes.at(0.6, 0.1), 0.8);
  EXPECT_EQ(stripes.at(0.6, 0.6), 0.8);
}

TEST(Shapes, ReportTheFieldTheValueAndTheRule) {
  const auto message = [](const Shape& shape) -> std::string {
    try {
      validate(shape);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(Sphere{.radius_m = -1}), "sphere.radius_m = -1; must be finite and > 0");
  EXPECT_EQ(message(Plane{.normal = {0, 0, 0}}), "plane.normal = 0 0 0; must not be zero");
  EXPECT_EQ(message(Box{.texture = {.albedo = 2}}), "texture.albedo = 2; must be in [0, 1]");
  EXPECT_EQ(message(Box{}), "accepted");
}

TEST(TableTop, IsWithinTheCamerasRange) {
  const SceneImage scene = table_top_image(80, 60);
  scene.validate();
  float nearest = 100.0f, farthest = 0.0f, darkest = 1.0f, brightest = 0.0f;
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i) {
    if (std::isnan(scene.depth_m.pixels[i])) continue;
    nearest = std::min(nearest, scene.depth_m.pixels[i]);
    farthest = std::max(farthest, scene.depth_m.pixels[i]);
    darkest = std::min(darkest, scene.albedo.pixels[i]);
    brightest = std::max(brightest, scene.albedo.pixels[i]);
  }
  EXPECT_GT(nearest, 0.9f);
  EXPECT_LT(nearest, 1.2f);
  EXPECT_GT(farthest, 3.5f);
  EXPECT_LT(farthest, 5.0f);
  EXPECT_LE(darkest, 0.1f);
  EXPECT_GE(brightest, 0.9f);
}

TEST(TableTop, ShowsEveryShape) {
  const StagedScene staged = built_in_scene("table-top", 80, 60);
  const SceneImage whole = table_top_image(80, 60);
  for (std::size_t left_out = 0; left_out < staged.shapes.size(); ++left_out) {
    std::vector<Shape> others = staged.shapes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const SceneImage without = ray_cast(others, staged.view, staged.camera_to_world);
    int changed = 0;
    for (std::size_t i = 0; i < whole.depth_m.size(); ++i)
      changed += !(whole.depth_m.pixels[i] == without.depth_m.pixels[i]);
    EXPECT_GT(changed, 100) << "shape " << left_out << " covers less than 2 % of the picture";
  }
}

}  // namespace
}  // namespace tofsmith

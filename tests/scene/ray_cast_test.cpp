// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/ray_caster.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "generated_shapes.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

namespace {

using Pattern = Texture::Pattern;

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
    const Ray ray = ray_about_origin(i);
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
      const Ray ray = ray_about_origin(i, 2.0);
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

TEST(RayCaster, TestsEveryTriangleOfAMeshByDefault) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(tessellated_sphere(1), {0, 0, 2}, 1.0)};
  const RayCaster caster(shapes);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Ray ray = ray_about_origin(i);
    const auto hit = caster.nearest(ray), expected = nearest_hit(shapes, ray);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (hit) {
      EXPECT_EQ(hit->distance_m, expected->distance_m) << i;
    }
  }
}

struct NearSearch final : MeshSearch {
  void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
             std::int32_t shape) const override {
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
      nearest[lane] = {{1.0, -rays[lane].direction, 0.5}, shape};
  }
};

TEST(RayCaster, UsesTheGivenMeshSearch) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(unit_cube(), {0, 0, 900}, 1.0)};
  const auto searched = [](const Mesh& mesh) -> std::unique_ptr<const MeshSearch> {
    EXPECT_EQ(mesh.triangles.triangles.size(), unit_cube().triangles.size());
    return std::make_unique<NearSearch>();
  };
  const SeenScene seen = RayCaster(shapes, searched).see(PinholeView::centred(9, 7, 1.0));
  EXPECT_EQ(seen.shape.pixels, std::vector<std::int32_t>(9 * 7, 1));
  EXPECT_EQ(seen.image.depth_m(3, 3), 1.0f);
}

TEST(RayCaster, ReportsTheVisibleShape) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 5}},
                                     placed_mesh(unit_cube(), {0, 0, 3}, 0.5),
                                     Sphere{.centre = {0.6, 0, 3}, .radius_m = 0.2}};
  const PinholeView view = PinholeView::centred(61, 41, 1.0);
  const SeenScene seen = RayCaster(shapes).see(view);
  EXPECT_EQ(seen.shape(0, 0), 0);
  EXPECT_EQ(seen.shape(20, 30), 1);
  std::vector<int> counts(3);
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column) {
      const std::int32_t shape = seen.shape(row, column);
      ASSERT_GE(shape, 0);
      ++counts[static_cast<std::size_t>(shape)];
      const auto alone = nearest_hit(std::span(&shapes[static_cast<std::size_t>(shape)], 1),
                                     {{0, 0, 0}, view.ray(row, column)});
      ASSERT_TRUE(alone);
      EXPECT_FLOAT_EQ(seen.image.depth_m(row, column), static_cast<float>(alone->distance_m));
    }
  EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 20);
}

TEST(RayCaster, RejectsInvalidShapesAndPoses) {
  Mesh broken = placed_mesh(unit_cube(), {0, 0, 2}, 1.0);
  broken.triangles.vertices[0].x() = NAN;
  EXPECT_THROW(RayCaster(std::vector<Shape>{broken}), std::invalid_argument);
  const RayCaster nothing(std::vector<Shape>{});
  EXPECT_FALSE(nothing.nearest(ray_about_origin(1)));
  const PinholeView view = PinholeView::centred(8, 8, 1.0);
  EXPECT_EQ(nothing.see(view).shape.pixels, std::vector<std::int32_t>(64, -1));
  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear() *= 1.1;
  EXPECT_THROW(nothing.see(view, stretched), std::invalid_argument);
  EXPECT_THROW(nothing.see(PinholeView{}), std::invalid_argument);
}

TEST(RayCaster, APlaneBeyondTheRangeOfFloatsReturnsNothing) {
  const std::vector<Shape> shapes = {Plane{.point = {0, 0, 1e60}}};
  const SeenScene seen = RayCaster(shapes).see(PinholeView::centred(4, 4, 1.0));
  seen.image.validate();
  EXPECT_EQ(seen.shape.pixels, std::vector<std::int32_t>(16, -1));
}

const Capsule oblique{.start = {0.4, -0.9, 0.2}, .end = {-0.5, 1.1, 0.8}, .radius_m = 0.7};

double distance_to_segment(const Capsule& capsule, const Eigen::Vector3d& point) {
  const Eigen::Vector3d span = capsule.end - capsule.start;
  const double share = std::clamp(span.dot(point - capsule.start) / span.squaredNorm(), 0.0, 1.0);
  return (point - capsule.start - share * span).norm();
}

TEST(Capsule, HitsAreOneRadiusFromTheSegmentAndNearest) {
  int outside_hits = 0, inside_hits = 0;
  for (std::uint64_t i = 0; i < 1500; ++i) {
    const Ray ray = ray_about_origin(i, 1.5);
    const auto hit = intersect(oblique, ray);
    const bool inside = distance_to_segment(oblique, ray.origin) < oblique.radius_m;
    // The signed distance to the surface changes sign at a hit: search in small steps.
    const double end_m = hit ? hit->distance_m : 12.0;
    for (double t = 0.0; t < end_m - 1e-6; t += 0.02)
      ASSERT_EQ(distance_to_segment(oblique, ray.origin + t * ray.direction) < oblique.radius_m,
                inside)
          << "ray " << i << " crosses the surface at " << t << ", before its hit";
    if (!hit) continue;
    ++(inside ? inside_hits : outside_hits);
    const Eigen::Vector3d at = ray.origin + hit->distance_m * ray.direction;
    EXPECT_NEAR(distance_to_segment(oblique, at), oblique.radius_m, 1e-12);
    EXPECT_NEAR(hit->normal.norm(), 1.0, 1e-12);
    EXPECT_EQ(hit->normal.dot(ray.direction) < 0.0, !inside);
  }
  EXPECT_GT(outside_hits, 50);
  EXPECT_GT(inside_hits, 5);
}

TEST(Capsule, OfZeroLengthIsASphere) {
  const Capsule point{.start = {0.3, 0.1, -0.2}, .end = {0.3, 0.1, -0.2}, .radius_m = 1.2};
  const Sphere sphere{.centre = point.start, .radius_m = point.radius_m};
  int hits = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Ray ray = ray_about_origin(i, 1.5);
    const auto one = intersect(point, ray);
    const auto other = intersect(sphere, ray);
    ASSERT_EQ(one.has_value(), other.has_value()) << i;
    if (!one) continue;
    ++hits;
    EXPECT_NEAR(one->distance_m, other->distance_m, 1e-12);
    EXPECT_NEAR((one->normal - other->normal).norm(), 0.0, 1e-12);
  }
  EXPECT_GT(hits, 30);
}

TEST(Capsule, DepthOnTheAxisIsTheNearEndMinusTheRadius) {
  const Capsule pole{.start = {0, 0, 5}, .end = {0, 0, 3}, .radius_m = 0.5};
  const auto along = intersect(pole, {{0, 0, 0}, {0, 0, 1}});
  ASSERT_TRUE(along);
  EXPECT_DOUBLE_EQ(along->distance_m, 2.5);
}

TEST(Capsule, RejectsARadiusOfZero) {
  EXPECT_THROW(validate(Capsule{.radius_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(validate(Capsule{.end = {0, NAN, 0}}), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith

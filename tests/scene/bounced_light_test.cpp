// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/bounced_light.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {
namespace {

using Eigen::Vector3d;

struct Sum {
  double ratio = 0.0;
  double delay_m = 0.0;
};

Sum sum_of(const MultipathReturns& light, int row, int column, double direct_m) {
  Sum sum;
  for (const MultipathReturn& later : light.of(row, column)) {
    sum.ratio += static_cast<double>(later.ratio);
    sum.delay_m +=
        static_cast<double>(later.ratio) * (static_cast<double>(later.distance_m) - direct_m);
  }
  sum.delay_m /= sum.ratio;
  return sum;
}

/// A camera of one pixel at `from` looks at `at`.
StagedScene looking(std::vector<Shape> shapes, const Vector3d& from, const Vector3d& at) {
  StagedScene scene{.shapes = std::move(shapes), .view = {1.0, 1.0, 0.0, 0.0, 1, 1}};
  scene.camera_to_world.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), at - from).toRotationMatrix();
  scene.camera_to_world.translation() = from;
  return scene;
}

Shape wall(const Vector3d& normal, double albedo) {
  return Plane{.normal = normal, .texture = {.albedo = albedo}};
}

/// Returns a wall as a mesh of two triangles, 400 m wide, that begins at x = y = 0.
Shape mesh_wall(const Vector3d& along, double albedo) {
  const Vector3d z(0, 0, 200);
  Mesh mesh;
  mesh.triangles = {.vertices = {-z, z, 400 * along - z, 400 * along + z},
                    .triangles = {{0, 1, 2}, {1, 3, 2}}};
  mesh.texture.albedo = albedo;
  return mesh;
}

/// Light at the point (0, height, 0) of the wall x = 0 by way of the wall y = 0, integrated over
/// that wall by the midpoint rule in polar coordinates about the nearest point of the edge.
Sum by_quadrature(const Vector3d& light, double height_m, double albedo) {
  const Vector3d seen(0, height_m, 0), to_light = light - seen;
  const double d1 = to_light.norm(), cos1 = to_light.x() / d1;
  Sum sum;
  constexpr int radii = 1500, angles = 300;
  for (int i = 0; i < radii; ++i) {
    const double share = (i + 0.5) / radii, radius = height_m * share / (1 - share);
    const double step = height_m / (1 - share) / (1 - share) / radii;
    for (int j = 0; j < angles; ++j) {
      const double angle = std::numbers::pi * ((j + 0.5) / angles - 0.5);
      const Vector3d place(radius * std::cos(angle), 0, radius * std::sin(angle));
      const double s = (place - seen).norm(), d2 = (place - light).norm();
      const double part = albedo / std::numbers::pi * (light.y() / d2) / (d2 * d2) *
                          (place.x() / s) * (height_m / s) / (s * s) * radius * step *
                          std::numbers::pi / angles * d1 * d1 / cos1;
      sum.ratio += part;
      sum.delay_m += part * 0.5 * (d2 + s - d1);
    }
  }
  sum.delay_m /= sum.ratio;
  return sum;
}

TEST(BouncedLight, OfADistantSourceBetweenPerpendicularWallsIsHalfTheAlbedo) {
  // The other wall fills half of the cosine-weighted hemisphere and is lit equally.
  const auto scene = looking({wall(Vector3d::UnitX(), 0.3), wall(Vector3d::UnitY(), 0.8)},
                             {2e4, 2e4, 0}, {0, 1, 0});
  const MultipathReturns light = bounced_light(scene, {.rays = 8192});
  EXPECT_NEAR(sum_of(light, 0, 0, 0.0).ratio, 0.5 * 0.8, 0.002);
}

TEST(BouncedLight, BetweenPerpendicularWallsMatchesQuadrature) {
  const Vector3d from(1.5, 2.0, 0.0);
  for (const double height_m : {0.2, 1.0, 1.9}) {
    const Sum expected = by_quadrature(from, height_m, 0.8);
    for (const bool as_mesh : {false, true}) {
      std::vector<Shape> shapes = {wall(Vector3d::UnitX(), 0.3), wall(Vector3d::UnitY(), 0.8)};
      if (as_mesh) shapes = {mesh_wall(Vector3d::UnitY(), 0.3), mesh_wall(Vector3d::UnitX(), 0.8)};
      const StagedScene scene = looking(shapes, from, {0, height_m, 0});
      const double direct_m = (from - Vector3d(0, height_m, 0)).norm();
      const Sum found = sum_of(bounced_light(scene, {.rays = 8192}), 0, 0, direct_m);
      EXPECT_NEAR(found.ratio, expected.ratio, 0.004 * expected.ratio) << height_m << as_mesh;
      EXPECT_NEAR(found.delay_m, expected.delay_m, 0.004 * expected.delay_m) << height_m;
    }
  }
}

TEST(BouncedLight, WithinASphereIsTheAlbedoDelayedByTwoThirdsOfTheRadius) {
  const auto scene = looking({Sphere{.radius_m = 1.5, .texture = {.albedo = 0.6}}},
                             Vector3d::Zero(), {0.3, -0.4, 1.2});
  const Sum sum = sum_of(bounced_light(scene, {.rays = 4096}), 0, 0, 1.5);
  EXPECT_NEAR(sum.ratio, 0.6, 1e-5);
  EXPECT_NEAR(sum.delay_m, 1.0, 1e-3);
}

TEST(BouncedLight, IsIndependentOfTheBinWidthAndWrapsAtTheRange) {
  const StagedScene scene = built_in_scene("corner", 3, 2);
  const MultipathReturns fine = bounced_light(scene, {.rays = 64, .bin_m = 1e-6});
  const MultipathReturns coarse = bounced_light(scene, {.rays = 64, .bin_m = 0.2});
  const SceneImage image = RayCaster(scene.shapes).see(scene.view, scene.camera_to_world).image;
  const double direct_m = static_cast<double>(image.depth_m(0, 0));
  const Sum a = sum_of(fine, 0, 0, direct_m), b = sum_of(coarse, 0, 0, direct_m);
  EXPECT_GT(fine.of(0, 0).size(), coarse.of(0, 0).size());
  EXPECT_NEAR(a.ratio, b.ratio, 1e-6);
  EXPECT_NEAR(a.delay_m, b.delay_m, 1e-5);
  const MultipathReturns wrapped = bounced_light(scene, {.rays = 64, .range_m = 0.5});
  wrapped.validate(image, 0.5);
  EXPECT_NEAR(sum_of(wrapped, 0, 0, direct_m).ratio, a.ratio, 1e-6);
}

TEST(BouncedLight, HasLessThanOnePercentNoiseAndConverges) {
  const StagedScene scene = built_in_scene("corner", 24, 1);
  const auto ratios = [&](int rays, std::uint64_t seed) {
    Eigen::ArrayXd all(24);
    const MultipathReturns light = bounced_light(scene, {.rays = rays, .seed = seed});
    for (int i = 0; i < 24; ++i) all[i] = sum_of(light, 0, i, 0.0).ratio;
    return all;
  };
  const Eigen::ArrayXd truth = ratios(32768, 9);
  const auto noise = [&](int rays) {
    double sum = 0.0;
    for (const std::uint64_t seed : {1, 2, 3, 4})
      sum += ((ratios(rays, seed) - truth) / truth).square().mean();
    return std::sqrt(sum / 4);
  };
  const double standard = noise(BounceOptions().rays);
  RecordProperty("relative_noise", std::to_string(standard));
  EXPECT_LT(standard, 0.01);
  EXPECT_LT(noise(8 * BounceOptions().rays), 0.5 * standard);
}

TEST(BouncedLight, ComesFromLitSurfacesOnly) {
  // A black screen shadows the second wall, except for light that passes its distant ends.
  const Vector3d from(2, 2, 0);
  std::vector<Shape> shapes = {wall(Vector3d::UnitX(), 0.5), wall(Vector3d::UnitY(), 0.5)};
  const double open = sum_of(bounced_light(looking(shapes, from, {0, 1.8, 0})), 0, 0, 0.0).ratio;
  shapes.emplace_back(
      Box{.centre = {2, 1.5, 0}, .size_m = {500, 0.02, 500}, .texture = {.albedo = 0.0}});
  EXPECT_GT(open, 0.05);
  EXPECT_LT(sum_of(bounced_light(looking(shapes, from, {0, 1.8, 0})), 0, 0, 0.0).ratio,
            1e-4 * open);
  EXPECT_TRUE(bounced_light(built_in_scene("wall", 4, 3)).empty()) << "a wall alone";
}

TEST(BouncedLight, RejectsInvalidOptions) {
  const StagedScene scene = built_in_scene("corner", 2, 2);
  EXPECT_THAT([&] { bounced_light(scene, {.rays = 8}); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("BounceOptions::rays = 8; must be in [16, 65536]")));
  EXPECT_THROW(bounced_light(scene, {.bin_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(bounced_light(scene, {.range_m = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {
namespace {

Ray random_ray(std::uint64_t item) {
  RandomStream random(17, item);
  const Eigen::Vector3d origin(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  return {1.5 * origin, direction.normalized()};
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
    const Ray ray = random_ray(i);
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
    const Ray ray = random_ray(i);
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
  const auto across = intersect(pole, {{2, 0, 4}, {-1, 0, 0}});
  ASSERT_TRUE(across);
  EXPECT_DOUBLE_EQ(across->distance_m, 1.5);
}

TEST(Capsule, RejectsARadiusOfZero) {
  EXPECT_THROW(validate(Capsule{.radius_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(validate(Capsule{.end = {0, NAN, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

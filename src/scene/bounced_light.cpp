// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/bounced_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/shared/random.hpp"
#include "core/shared/shared_progress.hpp"
#include "scene/rigid.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

/// Offset of ray origins, relative to the distance from the camera.
constexpr double lift = 4e-5;
/// Minimum distance of occluders, relative to the distance of the point.
constexpr double shadow_slack = 1e-5;
constexpr double min_cosine = 1e-6;

struct Bounce {
  double delay_m = 0.0;  ///< relative to the direct return
  double ratio = 0.0;
};

bool comes_before(const Bounce& a, const Bounce& b) {
  return a.delay_m < b.delay_m || (a.delay_m == b.delay_m && a.ratio < b.ratio);
}

struct SeenPoint {
  Eigen::Vector3d place, normal;  ///< the normal points to the camera
  double distance_m = 0.0;
  double per_bounce = 0.0;  ///< d1^2 / cos a1 / rays
};

class BounceGatherer {
 public:
  BounceGatherer(const StagedScene& scene, const BounceOptions& options,
                 const MeshSearchMaker& search_of)
      : scene_(scene),
        options_(options),
        caster_(scene.shapes, search_of),
        light_(scene.camera_to_world.translation()) {}

  std::vector<MultipathReturn> gather(int row, int column) const;

 private:
  std::optional<SeenPoint> seen_point(int row, int column) const;
  std::vector<Bounce> bounces(const SeenPoint& seen, RandomStream& random) const;
  std::optional<Bounce> bounce(const SeenPoint& seen, const Ray& ray, const Hit& hit) const;
  std::vector<MultipathReturn> merged(const std::vector<Bounce>& bounces, float direct_m) const;

  const StagedScene& scene_;
  const BounceOptions& options_;
  RayCaster caster_;
  Eigen::Vector3d light_;
};

std::optional<SeenPoint> BounceGatherer::seen_point(int row, int column) const {
  const Ray ray{light_, scene_.camera_to_world.linear() * scene_.view.ray(row, column)};
  const std::optional<Hit> hit = caster_.nearest(ray);
  if (!hit || !std::isfinite(static_cast<float>(hit->distance_m))) return std::nullopt;
  const double along = hit->normal.dot(ray.direction);
  if (std::abs(along) < min_cosine) return std::nullopt;
  return SeenPoint{light_ + hit->distance_m * ray.direction,
                   along > 0.0 ? Eigen::Vector3d(-hit->normal) : hit->normal, hit->distance_m,
                   hit->distance_m * hit->distance_m / std::abs(along) / options_.rays};
}

std::optional<Bounce> BounceGatherer::bounce(const SeenPoint& seen, const Ray& ray,
                                             const Hit& hit) const {
  const Eigen::Vector3d place = ray.origin + hit.distance_m * ray.direction;
  const Eigen::Vector3d from_light = place - light_;
  const double distance_m = from_light.norm();
  const double along = hit.normal.dot(from_light) / distance_m;
  if (!(along * hit.normal.dot(ray.direction) > 0.0) || !std::isfinite(distance_m))
    return std::nullopt;
  const std::optional<Hit> first = caster_.nearest({light_, from_light / distance_m});
  if (first && first->distance_m < distance_m * (1 - shadow_slack)) return std::nullopt;
  const double way_m = distance_m + (place - seen.place).norm() - seen.distance_m;
  return Bounce{0.5 * std::max(0.0, way_m),
                seen.per_bounce * hit.albedo * std::abs(along) / (distance_m * distance_m)};
}

std::vector<Bounce> BounceGatherer::bounces(const SeenPoint& seen, RandomStream& random) const {
  const Eigen::Vector3d across = seen.normal.unitOrthogonal();
  const Eigen::Vector3d other = seen.normal.cross(across);
  const Eigen::Vector3d start = seen.place + lift * seen.distance_m * seen.normal;
  const double first_shift = random.uniform(), second_shift = random.uniform();
  const auto fraction = [](double value) { return value - std::floor(value); };
  std::vector<Bounce> result;
  for (int i = 0; i < options_.rays; ++i) {
    const double area = fraction(static_cast<double>(i) / options_.rays + first_shift);
    const double angle = 2 * std::numbers::pi * fraction(i * std::numbers::phi + second_shift);
    const double sine = std::sqrt(area);
    const Eigen::Vector3d direction = sine * std::cos(angle) * across +
                                      sine * std::sin(angle) * other +
                                      std::sqrt(1 - area) * seen.normal;
    const Ray ray{start, direction};
    const std::optional<Hit> hit = caster_.nearest(ray);
    if (!hit) continue;
    if (const auto light = bounce(seen, ray, *hit); light && light->ratio > 0.0)
      result.push_back(*light);
  }
  return result;
}

std::vector<MultipathReturn> BounceGatherer::merged(const std::vector<Bounce>& bounces,
                                                    float direct_m) const {
  std::vector<MultipathReturn> returns;
  double bin = -1.0;
  Bounce sum;  // of the current bin, weighted by light
  const auto close_bin = [&] {
    if (sum.ratio > 0.0)
      returns.push_back(
          {direct_m + static_cast<float>(sum.delay_m / sum.ratio), static_cast<float>(sum.ratio)});
    sum = {};
  };
  for (const Bounce& b : bounces) {
    if (const double its = std::floor(b.delay_m / options_.bin_m); its != bin) {
      close_bin();
      bin = its;
    }
    sum.ratio += b.ratio;
    sum.delay_m += b.ratio * b.delay_m;
  }
  close_bin();
  return returns;
}

std::vector<MultipathReturn> BounceGatherer::gather(int row, int column) const {
  const std::optional<SeenPoint> seen = seen_point(row, column);
  if (!seen) return {};
  RandomStream random(options_.seed, static_cast<std::uint64_t>(row) *
                                             static_cast<std::uint64_t>(scene_.view.width) +
                                         static_cast<std::uint64_t>(column));
  std::vector<Bounce> found = bounces(*seen, random);
  if (std::isfinite(options_.range_m))
    for (Bounce& b : found)  // rounded distances must stay below the range
      b.delay_m = std::min(std::fmod(b.delay_m, options_.range_m), options_.range_m * (1 - 1e-5));
  std::sort(found.begin(), found.end(), comes_before);
  return merged(found, static_cast<float>(seen->distance_m));
}

}  // namespace

void BounceOptions::validate() const { check_fields(*this, "BounceOptions::"); }

MultipathReturns bounced_light(const StagedScene& scene, const BounceOptions& options,
                               const Progress& progress, const MeshSearchMaker& search_of) {
  options.validate();
  scene.view.validate();
  require_rigid(scene.camera_to_world, "camera_to_world");
  const BounceGatherer gatherer(scene, options, search_of);
  const int height = scene.view.height, width = scene.view.width;
  MultipathReturns result(height, width);
  std::vector<std::vector<MultipathReturn>> of_row(static_cast<std::size_t>(width));
  SharedProgress shared(progress, static_cast<double>(height) * width, "gathering bounced light");
  for (int row = 0; row < height; ++row) {
    parallel_for(width, [&](std::int64_t column) {
      of_row[static_cast<std::size_t>(column)] = gatherer.gather(row, static_cast<int>(column));
      shared.add();
    });
    for (const std::vector<MultipathReturn>& of_pixel : of_row) result.append_pixel(of_pixel);
  }
  report(progress, 1.0, "gathering bounced light");
  return result;
}

namespace {

std::string name_of_return(int row, int column, std::size_t number, const char* field) {
  return "return " + std::to_string(number) + " of pixel (" + std::to_string(row) + ", " +
         std::to_string(column) + "): " + field;
}

void validate_pixel(std::span<const MultipathReturn> returns, int row, int column, double direct_m,
                    double range_m) {
  double before_m = direct_m;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto [distance_m, ratio] = returns[i];
    const auto name = [&](const char* field) { return name_of_return(row, column, i, field); };
    require(std::isfinite(ratio) && ratio >= 0.0f, name("ratio"), ratio, "must be finite and >= 0");
    require(!std::isnan(direct_m), name("distance_m"), distance_m,
            "must not exist, because the pixel has no direct return");
    require(std::isfinite(distance_m) && distance_m >= before_m, name("distance_m"), distance_m,
            i == 0 ? "must be finite and not nearer than the direct return at " +
                         fmt::format("{:f}", before_m) + " m"
                   : "must be finite and in order, not nearer than the previous return at " +
                         fmt::format("{:f}", before_m) + " m");
    require(distance_m - direct_m < range_m, name("distance_m"), distance_m,
            "must be less than the unambiguous range, " + fmt::format("{:f}", range_m) +
                " m, behind the direct return at " + fmt::format("{:f}", direct_m) + " m");
    before_m = distance_m;
  }
}

}  // namespace

void MultipathReturns::append_pixel(std::span<const MultipathReturn> of_pixel) {
  returns.insert(returns.end(), of_pixel.begin(), of_pixel.end());
  first.push_back(static_cast<std::int64_t>(returns.size()));
}

std::span<const MultipathReturn> MultipathReturns::of(int row, int column) const {
  const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column);
  return std::span(returns).subspan(static_cast<std::size_t>(first[pixel]),
                                    static_cast<std::size_t>(first[pixel + 1] - first[pixel]));
}

void MultipathReturns::validate(const SceneImage& scene, double range_m) const {
  require(height == scene.height(), "multipath returns: height", height,
          "must equal the scene's " + std::to_string(scene.height()));
  require(width == scene.width(), "multipath returns: width", width,
          "must equal the scene's " + std::to_string(scene.width()));
  const std::size_t pixels = scene.depth_m.size();
  require(first.size() == pixels + 1, "multipath returns: entries of first", first.size(),
          "must be one more than the scene's " + std::to_string(pixels) + " pixels");
  require(first.front() == 0, "multipath returns: first[0]", first.front(), "must be 0");
  for (std::size_t i = 0; i < pixels; ++i)
    require(first[i + 1] >= first[i], "multipath returns: first[" + std::to_string(i + 1) + "]",
            first[i + 1], "must not decrease");
  require(first.back() == static_cast<std::int64_t>(returns.size()),
          "multipath returns: last entry of first", first.back(),
          "must be the number of returns, " + std::to_string(returns.size()));
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      validate_pixel(of(row, column), row, column, scene.depth_m(row, column), range_m);
}

MultipathReturns behind_every_pixel(const SceneImage& scene,
                                    std::span<const MultipathReturn> behind) {
  MultipathReturns result(scene.height(), scene.width());
  std::vector<MultipathReturn> of_pixel;
  for (const float depth_m : scene.depth_m.pixels) {
    of_pixel.clear();
    if (!std::isnan(depth_m))
      for (const MultipathReturn& r : behind) of_pixel.push_back({depth_m + r.distance_m, r.ratio});
    result.append_pixel(of_pixel);
  }
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/object_scan.hpp"

#include <cmath>
#include <limits>

#include "paper/repeated_depth.hpp"
#include "paper/scene_views.hpp"
#include "paper/surface_fit.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith {

namespace {

CaptureOptions capture_options(double optical_density, int estimates, std::uint64_t seed) {
  const OperatingPoint light = PrototypeBench::light(optical_density);
  return {.signal_e_per_s = light.signal_e_per_s,
          .ambient_e_per_s = light.ambient_e_per_s,
          .seed = seed,
          .frames = estimates};
}

/// Pixels of a shape that `counts(row, column)` accepts.
template <typename Rule>
Image<std::uint8_t> region_of(const SeenScene& seen, int shape, const Rule& counts) {
  Image<std::uint8_t> region(seen.image.height(), seen.image.width());
  for (int row = 0; row < region.height; ++row)
    for (int column = 0; column < region.width; ++column)
      region(row, column) = seen.shape(row, column) == shape && counts(row, column) ? 1 : 0;
  return region;
}

/// Distances of the fitted surface along the rays of `points`, and what the fit is.
template <typename Surface>
std::vector<double> fitted_depths(const Surface& surface,
                                  const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> depths = residuals_along_rays(surface, points);
  for (std::size_t i = 0; i < points.size(); ++i) depths[i] = points[i].norm() - depths[i];
  return depths;
}

ObjectError error_of(const ScannedObject& object, const RepeatedDepth& depth) {
  RunningStatistics mean, outliers;
  std::vector<double> errors;
  for (std::size_t i = 0; i < object.region.size(); ++i) {
    const double error_m = depth.mean_abs_error_m.pixels[i];
    if (object.region.pixels[i] == 0 || !std::isfinite(error_m)) continue;
    mean.add(error_m);
    outliers.add(depth.outlier_rate.pixels[i]);
    errors.push_back(error_m);
  }
  return {mean.mean(), median_of(std::move(errors)), outliers.mean()};
}

}  // namespace

ScannedScene scanned_books(int width, int height) {
  const StagedScene staged = built_in_scene("books", width, height);
  const SeenScene seen = RayCaster(staged.shapes).see(staged.view, staged.camera_to_world);
  ScannedScene scene{.name = "books", .truth = seen.image, .view = staged.view, .objects = {}};
  const Image<float> z_m = z_from_radial(seen.image.depth_m, staged.view);
  const std::vector<std::pair<std::string, double>> fronts = {
      {"dark book", 1.2}, {"middle book", 1.4}, {"right book", 1.6}, {"wall", 3.2}};
  for (int i = 0; i < std::ssize(fronts); ++i) {
    const std::pair<std::string, double>& front = fronts[static_cast<std::size_t>(i)];
    const double front_m = front.second;
    scene.objects.push_back({front.first, false, region_of(seen, i, [&](int row, int column) {
                               return std::abs(z_m(row, column) - front_m) < 1e-3;
                             })});
  }
  return scene;
}

ScannedScene scanned_ball(int width, int height) {
  const StagedScene staged = built_in_scene("ball", width, height);
  const SeenScene seen = RayCaster(staged.shapes).see(staged.view, staged.camera_to_world);
  ScannedScene scene{.name = "ball", .truth = seen.image, .view = staged.view, .objects = {}};
  scene.objects.push_back({"volleyball", true, region_of(seen, 0, [&](int row, int column) {
                             return seen.image.cosine(row, column) > 0.26;
                           })});
  return scene;
}

Reference fit_reference(const ScannedScene& scene, const CodeSet& code, const Camera& camera,
                        int estimates, std::uint64_t seed, const Progress& progress) {
  const RepeatedDepth depth = repeated_depth(scene.truth, code, camera,
                                             capture_options(0.0, estimates, seed), {}, progress);
  Reference reference{.depth_m = Image<float>(scene.truth.height(), scene.truth.width(),
                                              std::numeric_limits<float>::quiet_NaN()),
                      .fits = {}};
  for (const ScannedObject& object : scene.objects) {
    const auto points = points_of(depth.mean_m, scene.view, object.region);
    ReferenceFit fit{.code = code.name(), .object = object.name};
    std::vector<double> fitted;
    if (object.sphere) {
      const auto sphere = fit_sphere(points);
      fitted = fitted_depths(sphere.surface, points);
      fit.rms_m = sphere.rms_m;
      fit.radius_m = sphere.surface.radius_m;
    } else {
      const auto plane = fit_plane(points);
      fitted = fitted_depths(plane.surface, points);
      fit.rms_m = plane.rms_m;
    }
    RunningStatistics offset;
    std::size_t next = 0;
    for (std::size_t i = 0; i < object.region.size(); ++i) {
      if (object.region.pixels[i] == 0) continue;
      reference.depth_m.pixels[i] = static_cast<float>(fitted[next]);
      if (std::isfinite(fitted[next])) offset.add(fitted[next] - scene.truth.depth_m.pixels[i]);
      ++next;
    }
    fit.offset_m = offset.mean();
    reference.fits.push_back(fit);
  }
  return reference;
}

ObjectScan scan_objects(const ScannedScene& scene, const CodeSet& code, const Camera& camera,
                        const Reference& reference, double optical_density, int estimates,
                        std::uint64_t seed, const Progress& progress) {
  const CaptureOptions light = capture_options(optical_density, estimates, seed);
  const RepeatedDepth depth = repeated_depth(
      scene.truth, code, camera, light,
      {.reference_m = reference.depth_m, .outlier_threshold_m = scan_outlier_m}, progress);
  CaptureOptions once = light;
  once.frames = 1;
  ObjectScan scan{.code = code.name(),
                  .optical_density = optical_density,
                  .estimate_m = repeated_depth(scene.truth, code, camera, once).mean_m,
                  .mean_error_m = depth.mean_abs_error_m,
                  .errors = {}};
  for (const ScannedObject& object : scene.objects) scan.errors.push_back(error_of(object, depth));
  return scan;
}

}  // namespace tofsmith

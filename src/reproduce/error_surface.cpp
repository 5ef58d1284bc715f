// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reproduce/error_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Trials after which the standard error of the linear error is about `relative` of it.
std::int64_t foreseen_trials(double circular_error_m, double range_m, double relative,
                             const SurfacePrecision& precision) {
  const double needed = range_m / (4.0 * circular_error_m * relative * relative);
  const auto most = static_cast<double>(precision.most_trials);
  std::int64_t trials = precision.first_trials;
  while (static_cast<double>(trials) < std::min(needed, most)) trials *= 2;
  return std::min(trials, precision.most_trials);
}

double wanted_standard_error(const OperatingPoint& point, const SurfacePrecision& precision) {
  const auto levels = named_levels();
  const bool named = std::ranges::any_of(levels, [&](const NamedLevel& l) {
    return std::abs(l.point.signal_e_per_s / point.signal_e_per_s - 1.0) < 1e-6 &&
           l.point.ambient_e_per_s == point.ambient_e_per_s;
  });
  return named ? std::min(precision.named_standard_error, precision.standard_error)
               : precision.standard_error;
}

Eigen::Index place_of(const std::vector<double>& levels, double level, const char* name) {
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (std::abs(levels[i] / level - 1.0) < 1e-6) return static_cast<Eigen::Index>(i);
  reject(name, fmt::format("{}", level), "must be a light level of the grid");
}

double relative_error(const Estimate& e) { return e.standard_error / e.value; }

}  // namespace

SurfacePrecision surface_precision(const ReproduceContext& context) {
  if (!context.options.fast) return {.seed = context.options.seed};
  return {.standard_error = 0.1,
          .named_standard_error = 0.1,
          .first_trials = 16000,
          .most_trials = 16000,
          .rotation_trials = 4000,
          .seed = context.options.seed};
}

Camera with_light_levels(Camera camera, const ReproduceContext& context) {
  if (context.options.fast) {
    camera.operating.signal_e_per_s = {std::pow(10.0, 3.5), 1e4, 1e5};
    camera.operating.ambient_e_per_s = {1e2, 1e4, 1e5};
  }
  return camera;
}

std::vector<NamedLevel> named_levels() {
  return {{"lo", {std::pow(10.0, 3.5), 1e4}}, {"mid", {1e4, 1e4}}, {"hi", {1e5, 1e4}}};
}

double ErrorSurface::worst_standard_error() const {
  return (linear_se_m.array() / linear_m.array()).maxCoeff();
}

Estimate ErrorSurface::linear_at(const OperatingPoint& point) const {
  const Eigen::Index s = place_of(signal_e_per_s, point.signal_e_per_s, "signal_e_per_s");
  const Eigen::Index a = place_of(ambient_e_per_s, point.ambient_e_per_s, "ambient_e_per_s");
  return {linear_m(a, s), linear_se_m(a, s)};
}

ErrorSurface measure_surface(const Contender& contender, const Camera& camera,
                             const SurfacePrecision& precision, const Progress& progress) {
  ErrorSurface surface{.name = contender.name,
                       .signal_e_per_s = camera.operating.signal_e_per_s,
                       .ambient_e_per_s = camera.operating.ambient_e_per_s};
  // 1. The best origin, by other random numbers than it is judged by.
  EvaluateOptions options = contender.decoding;
  options.trials = precision.rotation_trials;
  options.seed = precision.seed + 1;
  surface.rotation_bin =
      best_rotation(contender.code, camera, options, part_of(progress, 0.0, 0.1)).rotation_bin;
  const CodeSet code = contender.code.rotated(surface.rotation_bin);

  // 2. A first look, which tells how many trials every light level needs.
  options.trials = precision.first_trials;
  options.seed = precision.seed + 2;
  const DepthErrorReport look = evaluate(code, camera, options, part_of(progress, 0.1, 0.15));

  // 3. Where that is not exact enough, the level is measured by itself.
  const auto rows = static_cast<Eigen::Index>(surface.ambient_e_per_s.size());
  const auto columns = static_cast<Eigen::Index>(surface.signal_e_per_s.size());
  for (auto* values :
       {&surface.linear_m, &surface.linear_se_m, &surface.circular_m, &surface.circular_se_m})
    values->resize(rows, columns);
  std::vector<Estimate> linear, circular;
  for (std::size_t p = 0; p < look.points.size(); ++p) {
    report(progress, 0.15 + 0.85 * static_cast<double>(p) / static_cast<double>(look.points.size()),
           contender.name);
    PointDepthError error = look.points[p];
    Camera at_point = camera;
    at_point.operating.signal_e_per_s = {error.point.signal_e_per_s};
    at_point.operating.ambient_e_per_s = {error.point.ambient_e_per_s};
    const double wanted = wanted_standard_error(error.point, precision);
    const std::int64_t foreseen =
        foreseen_trials(error.circular_mde_m.value, camera.range_m(), wanted, precision);
    options.seed = precision.seed + 3 + p;
    options.trials = precision.first_trials;
    while (options.trials < precision.most_trials &&
           (options.trials < foreseen || relative_error(error.linear_mde_m) > wanted)) {
      options.trials = std::min(std::max(foreseen, 2 * options.trials), precision.most_trials);
      error = evaluate(code, at_point, options).points.front();
    }
    surface.trials += options.trials;
    const auto row = static_cast<Eigen::Index>(p) % rows;
    const auto column = static_cast<Eigen::Index>(p) / rows;  // points run signal by signal
    surface.linear_m(row, column) = error.linear_mde_m.value;
    surface.linear_se_m(row, column) = error.linear_mde_m.standard_error;
    surface.circular_m(row, column) = error.circular_mde_m.value;
    surface.circular_se_m(row, column) = error.circular_mde_m.standard_error;
    linear.push_back(error.linear_mde_m);
    circular.push_back(error.circular_mde_m);
  }
  surface.linear_geometric_mean_m = geometric_mean_of(linear);
  surface.circular_geometric_mean_m = geometric_mean_of(circular);
  return surface;
}

Eigen::MatrixXd least_linear_m(const std::vector<const ErrorSurface*>& surfaces) {
  Eigen::MatrixXd least = surfaces.front()->linear_m;
  for (const ErrorSurface* surface : surfaces) least = least.cwiseMin(surface->linear_m);
  return least;
}

double geometric_mean(const Eigen::MatrixXd& values) {
  return std::exp(values.array().log().mean());
}

}  // namespace tofsmith

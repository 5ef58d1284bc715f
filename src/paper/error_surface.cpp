// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/error_surface.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

Eigen::Index place_of(const std::vector<double>& levels, double level, const char* name) {
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (std::abs(levels[i] / level - 1.0) < 1e-6) return static_cast<Eigen::Index>(i);
  reject(name, fmt::format("{}", level), "must be a light level of the grid");
}

}  // namespace

SurfacePrecision surface_precision(const ReproduceContext& context) {
  if (!context.options.fast) return {.seed = context.options.seed};
  return {.standard_error = 0.1,
          .first_trials = 16000,
          .max_trials = 16000,
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
  const ProgressParts parts(progress, {10, 90});
  surface.rotation_bin = best_rotation(contender.code, camera, options, parts[0]).rotation_bin;
  const CodeSet code = contender.code.rotated(surface.rotation_bin);

  // 2. Every light level, with as many trials as it needs.
  options.trials = precision.first_trials;
  options.target_standard_error = precision.standard_error;
  options.max_trials = precision.max_trials;
  options.seed = precision.seed + 2;
  Camera judged = camera;
  judged.operating.error = DepthErrorKind::linear;
  const DepthErrorReport errors = evaluate(code, judged, options, parts[1]);

  const auto rows = static_cast<Eigen::Index>(surface.ambient_e_per_s.size());
  const auto columns = static_cast<Eigen::Index>(surface.signal_e_per_s.size());
  for (auto* values :
       {&surface.linear_m, &surface.linear_se_m, &surface.circular_m, &surface.circular_se_m})
    values->resize(rows, columns);
  for (std::size_t p = 0; p < errors.points.size(); ++p) {
    const PointDepthError& error = errors.points[p];
    const auto row = static_cast<Eigen::Index>(p) % rows;
    const auto column = static_cast<Eigen::Index>(p) / rows;  // points run signal by signal
    surface.linear_m(row, column) = error.linear_mde_m.value;
    surface.linear_se_m(row, column) = error.linear_mde_m.standard_error;
    surface.circular_m(row, column) = error.circular_mde_m.value;
    surface.circular_se_m(row, column) = error.circular_mde_m.standard_error;
    surface.trials += error.trials;
  }
  surface.linear_geometric_mean_m = errors.linear.geometric_mean_m;
  surface.circular_geometric_mean_m = errors.circular.geometric_mean_m;
  return surface;
}

double geometric_mean(const Eigen::MatrixXd& values) {
  return std::exp(values.array().log().mean());
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "paper/context.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A code and how it is decoded: one surface of depth error over signal and ambient light.
struct Contender {
  std::string name;
  CodeSet code;
  EvaluateOptions decoding = {};  ///< all that is not said by SurfacePrecision
};

/// How exactly a surface is measured.
struct SurfacePrecision {
  double standard_error = 0.02;          ///< of every value, relative, unless max_trials is less
  std::int64_t first_trials = 8000;      ///< per light level, before more are found needed
  std::int64_t max_trials = 50'000'000;  ///< per light level
  std::int64_t rotation_trials = 20000;  ///< per light level, to find the best origin
  std::uint64_t seed = 1;
};

/// What figures use: 2 % everywhere, 10 % with --fast.
SurfacePrecision surface_precision(const ReproduceContext& context);
/// The paper's light levels; 3 x 3 of them with --fast.
Camera with_light_levels(Camera camera, const ReproduceContext& context);

/// A light level the text speaks of.
struct NamedLevel {
  const char* name;
  OperatingPoint point;
};
/// lo, mid and hi: S = 10^3.5, 1e4 and 1e5 e/s, all at A = 1e4 e/s.
std::vector<NamedLevel> named_levels();

/// Mean depth error of a contender, ambient by signal (rows by columns) [m].
struct ErrorSurface {
  std::string name;
  std::vector<double> signal_e_per_s, ambient_e_per_s;
  int rotation_bin = 0;  ///< that was best for the linear error
  Eigen::MatrixXd linear_m, linear_se_m, circular_m, circular_se_m;
  Estimate linear_geometric_mean_m, circular_geometric_mean_m;
  std::int64_t trials = 0;  ///< of all light levels

  /// Largest relative standard error of the linear error; of the circular one it is smaller.
  double worst_standard_error() const;
  /// The linear error at a light level of the grid. @throws std::invalid_argument if it is not
  /// there
  Estimate linear_at(const OperatingPoint& point) const;
};

/// Measures the contender at every light level of the camera, at its best origin of depth for the
/// linear error, with as many trials as EvaluateOptions::target_standard_error takes.
ErrorSurface measure_surface(const Contender& contender, const Camera& camera,
                             const SurfacePrecision& precision, const Progress& progress = {});

/// exp(mean(log values)).
double geometric_mean(const Eigen::MatrixXd& values);

}  // namespace tofsmith

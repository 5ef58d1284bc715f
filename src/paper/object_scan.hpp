// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "paper/prototype_bench.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

/// Errors beyond are outliers, as in the paper [m].
inline constexpr double scan_outlier_m = 0.3;

/// An object whose errors are listed by themselves.
struct ScannedObject {
  std::string name;
  bool sphere = false;         ///< else a plane
  Image<std::uint8_t> region;  ///< (H, W), 1 where its errors count
};

/// A scene, and what is compared in it.
struct ScannedScene {
  std::string name;
  SceneImage truth;
  PinholeView view;
  std::vector<ScannedObject> objects;
};

/// Three books and a wall behind them, each the pixels of its front.
ScannedScene scanned_books(int width, int height);
/// The ball, where it is seen at less than 75 degrees from its normal.
ScannedScene scanned_ball(int width, int height);

/// The surface through an object's mean depths without filter, as an experimenter would fit it.
struct ReferenceFit {
  std::string code, object;
  double rms_m = 0.0;     ///< of the points about the surface
  double offset_m = 0.0;  ///< mean of fitted less true depth
  double radius_m = 0.0;  ///< of a sphere
};

/// Fits every object of a code's scan without filter.
struct Reference {
  Image<float> depth_m;  ///< of the fitted surfaces along every ray, NaN outside the objects
  std::vector<ReferenceFit> fits;
};
Reference fit_reference(const ScannedScene& scene, const CodeSet& code, const Camera& camera,
                        int estimates, std::uint64_t seed, const Progress& progress = {});

/// An object's errors in one scan.
struct ObjectError {
  double mean_m = 0.0;    ///< of all estimates
  double median_m = 0.0;  ///< over the points, of a point's mean error
  double outlier_rate = 0.0;
};

/// What one code makes of a scene behind one filter.
struct ObjectScan {
  std::string code;
  double optical_density = 0.0;
  Image<float> estimate_m;          ///< the first estimate
  Image<float> mean_error_m;        ///< of each point, NaN outside the objects
  std::vector<ObjectError> errors;  ///< by object
};
ObjectScan scan_objects(const ScannedScene& scene, const CodeSet& code, const Camera& camera,
                        const Reference& reference, double optical_density, int estimates,
                        std::uint64_t seed, const Progress& progress = {});

}  // namespace tofsmith

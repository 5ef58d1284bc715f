// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

inline Camera coarse_camera(const std::string& name,
                            DepthErrorKind error = DepthErrorKind::linear) {
  Camera camera = built_in_camera(name);
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e4, 1e5};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = error;
  return camera;
}

/// A design with these options takes a fraction of a second.
inline DesignOptions small_options(std::vector<int> exposures = {3}) {
  DesignOptions options;
  options.method = DesignMethod::factorize;
  options.exposures = std::move(exposures);
  options.baselines = {"sinusoid-k4", "square-k4", "hamiltonian-k4"};
  options.search_trials = 200;
  options.trials = 2000;
  options.factorize.random_starts = 2;
  options.factorize.max_iterations = 4;
  options.factorize.refined = 3;
  options.factorize.kept = 3;
  return options;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tofsmith/code/code_set.hpp"
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

/// Compares samples up to rounding.
inline void expect_same_samples(const CodeSet& a, const CodeSet& b) {
  ASSERT_EQ(a.samples(), b.samples());
  ASSERT_EQ(a.taps(), b.taps());
  ASSERT_EQ(a.exposures(), b.exposures());
  EXPECT_TRUE(a.modulation_samples().isApprox(b.modulation_samples(), 1e-12));
  EXPECT_TRUE(a.demodulation_samples().isApprox(b.demodulation_samples(), 1e-12));
}

inline void expect_same_functions(const CodeSet& a, const CodeSet& b) {
  ASSERT_EQ(a.samples(), b.samples());
  ASSERT_EQ(a.taps(), b.taps());
  ASSERT_EQ(a.exposures(), b.exposures());
  for (int e = 0; e < a.exposures(); ++e) EXPECT_EQ(a.modulation(e), b.modulation(e)) << e;
  for (int i = 0; i < a.measurements(); ++i) EXPECT_EQ(a.demodulation(i), b.demodulation(i)) << i;
}

/// Compares name and provenance, too.
inline void expect_same_code(const CodeSet& a, const CodeSet& b) {
  expect_same_functions(a, b);
  EXPECT_EQ(a.name(), b.name());
  EXPECT_EQ(a.provenance.method, b.provenance.method);
  EXPECT_EQ(a.provenance.camera, b.provenance.camera);
  EXPECT_EQ(a.provenance.seed, b.provenance.seed);
  EXPECT_EQ(a.provenance.version, b.provenance.version);
  EXPECT_EQ(a.provenance.residuals, b.provenance.residuals);
  EXPECT_EQ(a.provenance.depth_error_m, b.provenance.depth_error_m);
}

}  // namespace tofsmith

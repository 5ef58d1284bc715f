// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// 0 without operating points.
inline double brightest_ambient_e_per_s(const Camera& camera) {
  const auto& ambient = camera.operating.ambient_e_per_s;
  return ambient.empty() ? 0.0 : *std::max_element(ambient.begin(), ambient.end());
}

/// Criterion of unknown_ambient_gain(): the ambient light left in measurements (K) [e] is
/// negligible compared with their noise.
inline bool ambient_cancels(const Camera& camera, const Eigen::VectorXd& leak_e,
                            const Eigen::VectorXd& variance_e2) {
  constexpr double share_of_noise = 0.05;
  const Sensor& sensor = camera.sensor;
  return (sensor.subtracts() || sensor.readout == Readout::rows) &&
         !camera.operating.ambient_e_per_s.empty() &&
         (leak_e.array().abs() <= share_of_noise * variance_e2.array().sqrt()).all();
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

/// Photons counted in rows, in one exposure of one second.
inline Camera rows_camera(int samples = 60, double signal_e = 1e3, double ambient_e = 1e3) {
  Camera camera;
  camera.fundamental_frequency_hz = 5e6;
  camera.samples = samples;
  camera.exposure_s.total_s = 1.0;
  camera.light.peak_factor = 20.0;
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::gaussian, .cutoff_hz = 30e6};
  camera.sensor.readout = Readout::rows;
  camera.sensor.read_noise_e = 0.0;
  camera.operating.signal_e_per_s = {signal_e};
  camera.operating.ambient_e_per_s = {ambient_e};
  return camera;
}

inline Eigen::VectorXd bins_e(const ForwardModel& model, double depth_bin, double signal_e_per_s,
                              double ambient_e_per_s) {
  const Return seen{signal_e_per_s, depth_bin};
  return model.expected_tap_electrons({&seen, 1}, ambient_e_per_s);
}

}  // namespace tofsmith

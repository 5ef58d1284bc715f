// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

namespace tofsmith {

Camera AtlasCamera::camera() const {
  Camera camera = built_in_camera("paper-30x");
  camera.name = "atlas";
  camera.light.peak_factor = peak_factor;
  camera.sensor.taps = taps;
  camera.operating.error = error;
  if (shortest_pulse_periods > 0.0)
    camera.sensor.shortest_pulse_s = shortest_pulse_periods / camera.fundamental_frequency_hz;
  if (bandwidth_f0 > 0.0) {
    ImpulseResponse response;
    response.kind = ImpulseResponse::Kind::hann;
    response.f_max_hz = bandwidth_f0 * camera.fundamental_frequency_hz;
    camera.light.impulse_response = camera.sensor.impulse_response = response;
  }
  return camera;
}

}  // namespace tofsmith

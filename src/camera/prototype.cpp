// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/prototype.hpp"

#include <cmath>
#include <numbers>

namespace tofsmith {

Camera prototype_camera() {
  Camera camera;
  camera.name = "prototype";
  camera.fundamental_frequency_hz = 5e6;
  camera.exposure_s.total_s = 0.3;
  camera.samples = 300;
  camera.light.peak_factor = 15.0;
  camera.light.impulse_response.kind = ImpulseResponse::Kind::hann;
  camera.light.impulse_response.f_max_hz = 150e6;
  camera.light.generator = Generator{.sample_rate_hz = 500e6, .amplitude_bits = 14};
  camera.sensor.impulse_response = camera.light.impulse_response;
  camera.sensor.generator = camera.light.generator;
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.read_noise_e = 20.0 / std::numbers::sqrt2;
  camera.sensor.noise = NoiseModel::gaussian;  // as in the simulations of the paper
  constexpr double signal_at_od0_e_per_s = 1e6;
  for (const double optical_density : {3.0, 2.0, 1.0, 0.0})
    camera.operating.signal_e_per_s.push_back(signal_at_od0_e_per_s *
                                              std::pow(10.0, -optical_density));
  camera.operating.ambient_e_per_s = {1e3, 1e4};
  camera.validate();
  return camera;
}

}  // namespace tofsmith

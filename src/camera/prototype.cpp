// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/prototype.hpp"

#include <cmath>
#include <numbers>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void PrototypeSetting::validate() const {
  const auto positive = [](double value, std::string_view field) {
    require(std::isfinite(value) && value > 0.0, field, value, "must be finite and > 0");
  };
  positive(f_max_hz, "f_max_hz");
  positive(average_source_power_mw, "average_source_power_mw");
  positive(signal_at_od0_e_per_s, "signal_at_od0_e_per_s");
  require(!optical_densities.empty(), "optical_densities", "[]", "must list at least one filter");
}

Camera prototype_camera(const PrototypeSetting& setting) {
  setting.validate();
  Camera camera;
  camera.name = setting.name;
  camera.fundamental_frequency_hz = 5e6;
  camera.exposure_s.total_s = 0.3;
  camera.samples = 300;
  camera.light.peak_factor = setting.peak_factor;
  camera.light.impulse_response.kind = ImpulseResponse::Kind::hann;
  camera.light.impulse_response.f_max_hz = setting.f_max_hz;
  camera.light.generator = Generator{.sample_rate_hz = 500e6, .amplitude_bits = 14};
  camera.sensor.impulse_response = camera.light.impulse_response;
  camera.sensor.generator = camera.light.generator;
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.read_noise_e = 20.0 / std::numbers::sqrt2;
  camera.sensor.noise = NoiseModel::gaussian;  // as the paper simulates it

  const OperatingPoint unfiltered = {
      setting.signal_at_od0_e_per_s * setting.average_source_power_mw, 0.0};
  for (const double density : setting.optical_densities)
    camera.operating.signal_e_per_s.push_back(attenuated(unfiltered, density).signal_e_per_s);
  camera.operating.ambient_e_per_s = {1e3, 1e4};
  camera.validate();
  return camera;
}

std::vector<PrototypeSetting> prototype_settings() {
  return {{.name = "prototype", .peak_factor = 15.0},
          {.name = "prototype-p5", .peak_factor = 5.0},
          {.name = "prototype-p30", .peak_factor = 30.0}};
}

OperatingPoint attenuated(const OperatingPoint& point, double optical_density) {
  require(std::isfinite(optical_density) && optical_density >= 0.0, "optical_density",
          optical_density, "must be finite and >= 0");
  return {point.signal_e_per_s * std::pow(10.0, -optical_density), point.ambient_e_per_s};
}

}  // namespace tofsmith

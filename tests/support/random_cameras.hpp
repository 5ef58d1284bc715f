// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

inline double between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

inline double log_between(RandomStream& random, double low, double high) {
  return std::exp(between(random, std::log(low), std::log(high)));
}

inline bool one_in(RandomStream& random, int n) { return random.uniform() * n < 1.0; }

inline int whole_between(RandomStream& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}

namespace random_camera_parts {

inline std::vector<double> levels(RandomStream& random, double low, double high) {
  std::vector<double> values(static_cast<std::size_t>(whole_between(random, 1, 2)));
  for (double& value : values) value = log_between(random, low, high);
  return values;
}

inline ImpulseResponse response(RandomStream& random, double f0_hz) {
  ImpulseResponse response;
  const double limit_hz = f0_hz * log_between(random, 1.0, 60.0);
  switch (whole_between(random, 0, 5)) {
    case 0:
    case 1:
      response.kind = ImpulseResponse::Kind::none;
      break;
    case 2:
      response.kind = ImpulseResponse::Kind::hann;
      response.f_max_hz = limit_hz;
      break;
    case 3:
      response.kind = ImpulseResponse::Kind::gaussian;
      response.cutoff_hz = limit_hz;
      break;
    case 4:
      response.kind = ImpulseResponse::Kind::lowpass;
      response.cutoff_hz = limit_hz;
      break;
    default:  // a measured decay
      response.kind = ImpulseResponse::Kind::file;
      response.file = "measured.csv";
      response.time_step_s = 0.1 / limit_hz;
      for (int i = 0; i < 24; ++i)
        response.samples.push_back(std::exp(-0.3 * i) * between(random, 0.8, 1.2));
  }
  return response;
}

inline Generator generator(RandomStream& random, double f0_hz) {
  Generator generator;
  generator.sample_rate_hz = f0_hz * log_between(random, 8.0, 200.0);
  generator.amplitude_bits = whole_between(random, 1, 16);
  if (one_in(random, 3)) generator.table_points = whole_between(random, 8, 512);
  if (one_in(random, 3)) generator.edge_grid_s = 1.0 / (f0_hz * whole_between(random, 8, 256));
  return generator;
}

inline void set_sensor(Camera& camera, RandomStream& random) {
  const double f0_hz = camera.fundamental_frequency_hz;
  Sensor& sensor = camera.sensor;
  const int kind = whole_between(random, 0, 9);
  if (kind == 0) sensor.readout = Readout::rows;
  if (kind == 1) sensor.demodulation = Demodulation::weight;
  if (kind == 2 || kind == 3) sensor.readout = Readout::difference;
  if (kind >= 2 && kind <= 5) sensor.taps = 2;
  if (kind == 6) sensor.taps = whole_between(random, 3, 5);
  const bool has_rows = sensor.readout == Readout::rows;
  sensor.binary = !one_in(random, 3);
  sensor.impulse_response = response(random, f0_hz);
  if (one_in(random, 5)) sensor.edge_jitter_s = log_between(random, 1e-12, 1e-9);
  if (!has_rows && one_in(random, 5)) sensor.generator = generator(random, f0_hz);
  sensor.read_noise_e = one_in(random, 6) ? 0.0 : log_between(random, 1.0, 100.0);
  if (one_in(random, 3)) sensor.noise = NoiseModel::gaussian;
  if (one_in(random, 3)) sensor.dark_current_e_per_s = log_between(random, 1.0, 1e5);
  if (sensor.taps >= 2 || sensor.is_signed())
    if (one_in(random, 2)) sensor.modulation_contrast = between(random, 0.2, 1.0);
  if (!has_rows && one_in(random, 4)) sensor.tap_mismatch = between(random, -0.2, 0.2);
  if (!has_rows && one_in(random, 4)) sensor.full_well_e = log_between(random, 3e3, 1e6);
  if (!has_rows && one_in(random, 4)) {
    sensor.adc_bits = whole_between(random, 8, 16);
    sensor.gain_e_per_dn = log_between(random, 0.5, 20.0);
    if (one_in(random, 2)) sensor.black_level_dn = between(random, 1.0, 60.0);
  }
  if (one_in(random, 3))
    sensor.shortest_pulse_s = one_in(random, 2) ? log_between(random, 0.008, 0.1) / f0_hz
                                                : 1.0 / (f0_hz * whole_between(random, 6, 30));
  if (sensor.taps >= 2 && one_in(random, 2)) sensor.drain = false;
  if (one_in(random, 6)) sensor.readout_gap_s = log_between(random, 1e-5, 1e-3);
}

inline void set_light(Camera& camera, RandomStream& random) {
  const double f0_hz = camera.fundamental_frequency_hz;
  LightSource& light = camera.light;
  light.peak_factor = one_in(random, 15) ? 1.0 : log_between(random, 1.0, 40.0);
  if (one_in(random, 4)) light.peak_factor = std::max(1.0, std::round(light.peak_factor));
  light.binary = !one_in(random, 3);
  light.impulse_response = response(random, f0_hz);
  if (one_in(random, 5)) light.edge_jitter_s = log_between(random, 1e-12, 1e-9);
  if (one_in(random, 5)) light.generator = generator(random, f0_hz);
}

inline void set_operating(Camera& camera, RandomStream& random) {
  OperatingRange& operating = camera.operating;
  operating.signal_e_per_s = levels(random, 1e3, 1e7);
  operating.ambient_e_per_s = levels(random, 1e2, 1e7);
  if (one_in(random, 8)) operating.ambient_e_per_s = {0.0};
  operating.error = one_in(random, 2) ? DepthErrorKind::linear : DepthErrorKind::circular;
  if (one_in(random, 4)) operating.albedo = between(random, 0.1, 1.0);
  operating.uniform_albedo = one_in(random, 8);
  if (one_in(random, 6)) operating.neighbours = whole_between(random, 2, 25);
  const double range_m = camera.range_m();
  if (one_in(random, 6)) {
    operating.multipath = OperatingMultipath{};
    operating.multipath->delay_m = {0.05 * range_m, between(random, 0.1, 0.6) * range_m};
  }
  if (one_in(random, 5)) {
    const double nearest_m = between(random, 0.0, 0.4) * range_m;
    operating.working_distance_m = {nearest_m, nearest_m + between(random, 0.1, 0.5) * range_m};
  }
  if (one_in(random, 6)) {
    operating.depths.emplace(static_cast<std::size_t>(whole_between(random, 1, 9)));
    for (double& weight : *operating.depths) weight = random.uniform();
  }
}

inline void set_calibration(Camera& camera, RandomStream& random) {
  if (one_in(random, 5)) {
    Playback playback;
    if (camera.sensor.readout != Readout::rows) {
      playback.reversed = one_in(random, 2);
      playback.inverted = camera.sensor.taps <= 2 && one_in(random, 2);
    }
    if (one_in(random, 3)) {
      playback.order.resize(static_cast<std::size_t>(whole_between(random, 1, 5)));
      std::iota(playback.order.begin(), playback.order.end(), 0);
      for (std::size_t i = playback.order.size() - 1; i > 0; --i)
        std::swap(playback.order[i], playback.order[static_cast<std::size_t>(
                                         whole_between(random, 0, static_cast<int>(i)))]);
    }
    playback.offset_m = between(random, -1.0, 1.0);
    camera.playback = playback;
  }
  if (one_in(random, 5)) {
    camera.temperature = Temperature{.reference_c = 25.0,
                                     .offset_m_per_c = between(random, -1e-3, 1e-3),
                                     .signal_per_c = between(random, -0.01, 0.01),
                                     .now_c = between(random, -20.0, 80.0)};
    // Half of the light source's drift, the other way.
    camera.temperature->sensor =
        SensorTemperature{.offset_m_per_c = -0.5 * camera.temperature->offset_m_per_c,
                          .signal_per_c = -0.5 * camera.temperature->signal_per_c,
                          .now_c = camera.temperature->now_c};
  }
}

}  // namespace random_camera_parts

/// Returns a valid camera with random values of all keys relevant to design; determined by `seed`
/// and `index`.
inline Camera random_camera(std::uint64_t seed, std::uint64_t index) {
  RandomStream random(seed, index);
  Camera camera;
  camera.name = fmt::format("random-{}", index);
  camera.fundamental_frequency_hz = log_between(random, 1e6, 100e6);
  camera.samples =
      one_in(random, 3) ? whole_between(random, 8, 120) : 12 * whole_between(random, 2, 7);
  camera.exposure_s.total_s = log_between(random, 1e-3, 0.5);
  if (one_in(random, 6)) camera.exposure_s.each_s = random_camera_parts::levels(random, 1e-4, 0.1);
  random_camera_parts::set_light(camera, random);
  random_camera_parts::set_sensor(camera, random);
  random_camera_parts::set_operating(camera, random);
  random_camera_parts::set_calibration(camera, random);
  return camera;
}

}  // namespace tofsmith

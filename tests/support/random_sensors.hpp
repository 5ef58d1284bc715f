// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "random_cameras.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// A sensor chip with a list of 6 to 18 frequencies up to 240 MHz, or the dividers of a clock that
/// give multiples of its fundamental frequency, and a working distance in two of three cases.
inline Camera random_sensor(std::uint64_t seed, std::uint64_t index) {
  RandomStream random(seed, index);
  Camera camera;
  camera.name = fmt::format("sensor-{}", index + 1);
  camera.fundamental_frequency_hz = 1e6 * whole_between(random, 4, 12);
  camera.samples = 720;
  camera.exposure_s.total_s = log_between(random, 1e-3, 2e-2);
  camera.light.peak_factor = between(random, 2.0, 4.0);
  Sensor& sensor = camera.sensor;
  sensor.taps = one_in(random, 5) ? 1 : 2;
  if (sensor.taps == 2) {
    sensor.drain = false;
    sensor.modulation_contrast = between(random, 0.5, 1.0);
    if (!one_in(random, 3)) sensor.readout = Readout::difference;
  }
  sensor.read_noise_e = log_between(random, 5.0, 60.0);
  sensor.max_exposures = whole_between(random, 4, 10);
  for (ImpulseResponse* response : {&camera.light.impulse_response, &sensor.impulse_response}) {
    response->kind = ImpulseResponse::Kind::hann;
    response->f_max_hz = log_between(random, 1.5e8, 6e8);
  }
  SquareLight& square = camera.light.square.emplace();
  square.phase_steps = one_in(random, 4) ? 12 : 4;
  if (one_in(random, 2)) square.duty_range = {0.25, 0.5};
  const double f0_hz = camera.fundamental_frequency_hz;
  if (one_in(random, 3)) {
    square.clock_hz = 24.0 * f0_hz;
    square.dividers = {1, 2, 3, 4, 6, 8, 12, 24};
  } else {
    std::vector<double>& list = square.frequencies_hz.emplace();
    const int highest = static_cast<int>(between(random, 6e7, 2.4e8) / f0_hz);
    for (int count = whole_between(random, 6, 18); count > 0; --count) {
      const double frequency_hz = f0_hz * whole_between(random, 1, std::max(6, highest));
      if (std::count(list.begin(), list.end(), frequency_hz) == 0) list.push_back(frequency_hz);
    }
    if (std::count(list.begin(), list.end(), f0_hz) == 0) list.push_back(f0_hz);
  }
  const double signal = log_between(random, 1e5, 1e7);
  camera.operating.signal_e_per_s = {signal, 4.0 * signal, 16.0 * signal};
  camera.operating.ambient_e_per_s = {0.1 * signal, 3.0 * signal};
  camera.operating.error = DepthErrorKind::circular;
  if (!one_in(random, 3))
    camera.operating.working_distance_m = {0.3, camera.range_m() * between(random, 0.1, 0.9)};
  return camera;
}

}  // namespace tofsmith

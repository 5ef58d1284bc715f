// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/shared/raw_numbers.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

Camera judged_camera(const Camera& camera) {
  camera.validate();
  Camera judged = camera;
  if (camera.operating.neighbours == 1) return judged;
  const double n = camera.operating.neighbours;
  judged.operating.neighbours = 1;
  judged.exposure_s.total_s *= n;
  for (double& exposure_s : judged.exposure_s.each_s) exposure_s *= n;

  Sensor& sensor = judged.sensor;
  sensor.read_noise_e = std::sqrt(n * constant_variance_e2_of(sensor));
  double full_well_e = sensor.full_well_e.value_or(std::numeric_limits<double>::infinity());
  if (sensor.adc_bits) {
    const double max_dn = raw_numbers(sensor).max_dn;
    full_well_e = std::min(full_well_e,
                           (max_dn - sensor.black_level_dn.value_or(0.0)) * *sensor.gain_e_per_dn);
  }
  if (std::isfinite(full_well_e)) sensor.full_well_e = n * full_well_e;
  sensor.adc_bits.reset();
  sensor.gain_e_per_dn.reset();
  sensor.black_level_dn.reset();
  if (sensor.frame_period_s) *sensor.frame_period_s *= n;
  if (sensor.readout_gap_s) *sensor.readout_gap_s *= n;
  return judged;
}

Camera in_buckets(Camera camera) {
  Sensor& sensor = camera.sensor;
  if (!sensor.is_signed()) return camera;
  sensor.demodulation = Demodulation::gain;
  sensor.taps = 2;
  sensor.readout = Readout::difference;
  sensor.drain = false;
  sensor.tap_mismatch = 0.0;
  sensor.read_noise_e = std::sqrt(0.5 * constant_variance_e2_of(sensor));
  sensor.dark_current_e_per_s *= 0.5;
  sensor.full_well_e.reset();
  sensor.adc_bits.reset();
  sensor.gain_e_per_dn.reset();
  sensor.black_level_dn.reset();
  return camera;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/shared/raw_numbers.hpp"

namespace tofsmith {

namespace {

const Sensor& validated(const Sensor& sensor) {
  // The camera's checks are the sensor's; every other setting of a default camera is valid.
  Camera camera;
  camera.sensor = sensor;
  camera.operating = paper_operating_range();
  camera.validate();
  return sensor;
}

}  // namespace

PixelNoise::PixelNoise(const Sensor& sensor)
    : model_(validated(sensor).noise),
      subtracts_(sensor.subtracts()),
      is_signed_(sensor.is_signed()),
      read_noise_e_(sensor.read_noise_e),
      full_well_e_(sensor.full_well_e.value_or(std::numeric_limits<double>::infinity())),
      has_adc_(sensor.adc_bits.has_value()) {
  if (!has_adc_) return;
  gain_e_per_dn_ = *sensor.gain_e_per_dn;
  black_level_dn_ = sensor.black_level_dn.value_or(0.0);
  const ConverterNumbers numbers = raw_numbers(sensor);
  min_dn_ = numbers.min_dn;
  max_dn_ = numbers.max_dn;
}

double PixelNoise::draw_electrons(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (model_ == NoiseModel::gaussian)
    return mean + std::sqrt(mean + read_noise_e_ * read_noise_e_) * random.normal();
  return random.poisson(mean) + read_noise_e_ * random.normal();
}

double PixelNoise::draw_count(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (model_ == NoiseModel::gaussian) return mean + std::sqrt(mean) * random.normal();
  return random.poisson(mean);
}

double PixelNoise::draw_difference(double a, double b, RandomStream& random) const {
  const double variance = std::max(a + b, 0.0);
  if (model_ == NoiseModel::gaussian)
    return a - b + std::sqrt(variance + read_noise_e_ * read_noise_e_) * random.normal();
  const SignedElectrons electrons = SignedElectrons::of(a - b, variance);
  const double plus = random.poisson(electrons.plus), minus = random.poisson(electrons.minus);
  return electrons.size * (plus - minus) + read_noise_e_ * random.normal();
}

double PixelNoise::convert(double electrons) const {
  double kept = std::min(electrons, full_well_e_);
  if (is_signed_) kept = std::max(kept, -full_well_e_);
  if (!has_adc_) return kept;
  return std::clamp(std::round(kept / gain_e_per_dn_ + black_level_dn_), min_dn_, max_dn_);
}

void PixelNoise::read_out(double* raw, int tap_values) const {
  if (!subtracts_ || is_signed_) return;
  for (int i = 0; i < tap_values / 2; ++i) raw[i] = raw[2 * i] - raw[2 * i + 1];
}

}  // namespace tofsmith

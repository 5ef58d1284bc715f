// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/shared/raw_numbers.hpp"

namespace tofsmith {

namespace {

Sensor validated(const Sensor& sensor) {
  Camera camera;
  camera.sensor = sensor;
  camera.sensor.generator.reset();  // no effect on noise
  camera.operating = default_operating_range();
  camera.validate();
  return sensor;
}

}  // namespace

PixelNoise::PixelNoise(const Sensor& sensor)
    : parts_{.model = validated(sensor).noise,
             .subtracts = sensor.subtracts(),
             .is_signed = sensor.is_signed(),
             .read_noise_e = sensor.read_noise_e,
             .full_well_e = sensor.full_well_e.value_or(std::numeric_limits<double>::infinity()),
             .has_adc = sensor.adc_bits.has_value()} {
  if (!parts_.has_adc) return;
  parts_.gain_e_per_dn = *sensor.gain_e_per_dn;
  parts_.black_level_dn = sensor.black_level_dn.value_or(0.0);
  const ConverterNumbers numbers = raw_numbers(sensor);
  parts_.min_dn = numbers.min_dn;
  parts_.max_dn = numbers.max_dn;
}

double PixelNoise::draw_electrons(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (parts_.model == NoiseModel::gaussian)
    return mean + std::sqrt(mean + parts_.read_noise_e * parts_.read_noise_e) * random.normal();
  return random.poisson(mean) + parts_.read_noise_e * random.normal();
}

double PixelNoise::draw_count(double expected_e, RandomStream& random) const {
  const double mean = std::max(expected_e, 0.0);
  if (parts_.model == NoiseModel::gaussian) return mean + std::sqrt(mean) * random.normal();
  return random.poisson(mean);
}

double PixelNoise::draw_difference(double a, double b, RandomStream& random) const {
  const double variance = std::max(a + b, 0.0);
  if (parts_.model == NoiseModel::gaussian)
    return a - b +
           std::sqrt(variance + parts_.read_noise_e * parts_.read_noise_e) * random.normal();
  const SignedElectrons electrons = SignedElectrons::of(a - b, variance);
  const double plus = random.poisson(electrons.plus), minus = random.poisson(electrons.minus);
  return electrons.size * (plus - minus) + parts_.read_noise_e * random.normal();
}

double PixelNoise::convert(double electrons) const {
  double kept = std::min(electrons, parts_.full_well_e);
  if (parts_.is_signed) kept = std::max(kept, -parts_.full_well_e);
  if (!parts_.has_adc) return kept;
  return std::clamp(std::round(kept / parts_.gain_e_per_dn + parts_.black_level_dn), parts_.min_dn,
                    parts_.max_dn);
}

void PixelNoise::read_out(double* raw, int tap_values) const {
  if (!parts_.subtracts || parts_.is_signed) return;
  for (int i = 0; i < tap_values / 2; ++i) raw[i] = raw[2 * i] - raw[2 * i + 1];
}

}  // namespace tofsmith

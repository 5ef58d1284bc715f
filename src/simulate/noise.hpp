// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Parameters of a sensor's noise.
struct NoiseParts {
  NoiseModel model;
  bool subtracts, is_signed;
  double read_noise_e;
  double full_well_e;  ///< infinite: none
  bool has_adc;
  double gain_e_per_dn = 1.0, black_level_dn = 0.0, min_dn = 0.0, max_dn = 0.0;
};

/// From the electrons a tap is expected to collect to the raw number that leaves the sensor:
///   1. draw   Poisson electrons plus Gaussian read noise, or, with NoiseModel::gaussian, one
///             Gaussian of the same mean and variance, mu + sigma_r^2; both may come out negative;
///   2. clip   at full_well_e, only if it is set;
///   3. count  round(electrons / gain_e_per_dn + black_level_dn), held to [0, 2^bits - 1], only if
///             adc_bits is set; else the raw number is electrons;
///   4. read   every tap by itself, or the difference of each pair of buckets.
/// Of a mixer the difference of its two taps is drawn, and that is clipped, on both sides, counted
/// and read: see draw_difference().
/// Of rows, every time bin is drawn without read noise, which comes to the rows.
class PixelNoise {
 public:
  /// @throws std::invalid_argument if noise, read noise, full well or ADC settings are invalid
  explicit PixelNoise(const Sensor& sensor);

  /// Step 1: electrons with noise, for an expected number >= 0.
  double draw_electrons(double expected_e, RandomStream& random) const;
  /// The same without read noise.
  double draw_count(double expected_e, RandomStream& random) const;
  /// What a mixer gathers, of the expected electrons of its two taps: a number of mean a - b and
  /// variance a + b, and read noise. Poisson electrons of the two where neither is negative, which
  /// is exact for a weight that switches. A weight in between makes smaller steps: where b < 0,
  /// (a - b) / s Poisson electrons of s = (a + b) / (a - b) each, and the other way round.
  double draw_difference(double a, double b, RandomStream& random) const;
  double read_noise_e() const { return parts_.read_noise_e; }
  /// Steps 2 and 3: the raw number of one tap, [e] or [DN].
  double convert(double electrons) const;
  /// Step 4: raw measurements of a pixel from the raw numbers of its taps.
  /// @param raw  (tap values) in, (measurements) out, in place
  void read_out(double* raw, int tap_values) const;
  /// Measurements that leave the sensor for that many tap values.
  int measurements(int tap_values) const { return parts_.subtracts ? tap_values / 2 : tap_values; }

 private:
  NoiseParts parts_;
};

/// Poisson electrons of a mixer: so many of either sign are expected, of that size each.
struct SignedElectrons {
  double plus = 0.0, minus = 0.0, size = 1.0;

  /// Of mean and variance (PixelNoise::draw_difference()).
  static SignedElectrons of(double mean, double variance) {
    if (std::abs(mean) <= variance) return {0.5 * (variance + mean), 0.5 * (variance - mean), 1.0};
    const double size = std::max(variance, 0.0) / std::abs(mean);
    if (size < 1e-12) return {0.0, 0.0, 0.0};
    return {std::max(mean, 0.0) / size, std::max(-mean, 0.0) / size, size};
  }
};

}  // namespace tofsmith

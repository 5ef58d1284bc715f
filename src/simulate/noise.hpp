// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

struct NoiseParts {
  NoiseModel model;
  bool subtracts, is_signed;
  double read_noise_e;
  double full_well_e;  ///< infinite: no limit
  bool has_adc;
  double gain_e_per_dn = 1.0, black_level_dn = 0.0, min_dn = 0.0, max_dn = 0.0;
};

/// Converts the expected electrons of a tap to the raw number that leaves the sensor:
///   1. draw     Poisson electrons plus Gaussian read noise; or, with NoiseModel::gaussian, one
///              Gaussian of the same mean and variance, mu + sigma_r^2; both may be negative;
///   2. clip     at full_well_e, if it is set;
///   3. convert  round(electrons / gain_e_per_dn + black_level_dn), clipped to [0, 2^bits - 1], if
///              adc_bits is set, otherwise electrons;
///   4. read     every tap, or the difference of each pair of buckets.
/// The difference of the two taps of a mixer is drawn, clipped on both sides, converted and read.
/// For rows, every time bin is drawn without read noise, which is added to the rows.
class PixelNoise {
 public:
  explicit PixelNoise(const Sensor& sensor);

  /// Step 1. @param expected_e  >= 0
  double draw_electrons(double expected_e, RandomStream& random) const;
  /// Omits read noise.
  double draw_count(double expected_e, RandomStream& random) const;
  /// Draws the signal of a mixer from the expected electrons of its two taps, with mean a - b,
  /// variance a + b, and read noise. If neither is negative, both are Poisson, which is exact for
  /// weights that switch. Analog weights make smaller steps: if b < 0, the result is (a - b) / s
  /// Poisson electrons of size s = (a + b) / (a - b) each; similarly if a < 0.
  double draw_difference(double a, double b, RandomStream& random) const;
  double read_noise_e() const { return parts_.read_noise_e; }
  /// Steps 2 and 3 for one tap: [e] or [DN].
  double convert(double electrons) const;
  /// Step 4 in place.
  /// @param raw  (tap values) in, (measurements) out
  void read_out(double* raw, int tap_values) const;
  int measurements(int tap_values) const { return parts_.subtracts ? tap_values / 2 : tap_values; }

 private:
  NoiseParts parts_;
};

/// Poisson electrons of a mixer: expected numbers of both signs, and size of each.
struct SignedElectrons {
  double plus = 0.0, minus = 0.0, size = 1.0;

  static SignedElectrons of(double mean, double variance) {
    if (std::abs(mean) <= variance) return {0.5 * (variance + mean), 0.5 * (variance - mean), 1.0};
    const double size = std::max(variance, 0.0) / std::abs(mean);
    if (size < 1e-12) return {0.0, 0.0, 0.0};
    return {std::max(mean, 0.0) / size, std::max(-mean, 0.0) / size, size};
  }
};

}  // namespace tofsmith

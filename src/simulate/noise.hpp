// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// From the electrons a tap is expected to collect to the raw number that leaves the sensor:
///   1. draw   Poisson electrons plus Gaussian read noise, or, with NoiseModel::gaussian, one
///             Gaussian of the same mean and variance, mu + sigma_r^2; both may come out negative;
///   2. clip   at full_well_e, only if it is set;
///   3. count  round(electrons / gain_e_per_dn + black_level_dn), held to [0, 2^bits - 1], only if
///             adc_bits is set; else the raw number is electrons;
///   4. read   every tap by itself, or the difference of each pair of buckets.
/// Of rows, every time bin is drawn without read noise, which comes to the rows.
class PixelNoise {
 public:
  /// @throws std::invalid_argument if noise, read noise, full well or ADC settings are invalid
  explicit PixelNoise(const Sensor& sensor);

  /// Step 1: electrons with noise, for an expected number >= 0.
  double draw_electrons(double expected_e, RandomStream& random) const;
  /// The same without read noise.
  double draw_count(double expected_e, RandomStream& random) const;
  double read_noise_e() const { return read_noise_e_; }
  /// Steps 2 and 3: the raw number of one tap, [e] or [DN].
  double convert(double electrons) const;
  /// Step 4: raw measurements of a pixel from the raw numbers of its taps.
  /// @param raw  (tap values) in, (measurements) out, in place
  void read_out(double* raw, int tap_values) const;
  /// Measurements that leave the sensor for that many tap values.
  int measurements(int tap_values) const {
    return readout_ == Readout::difference ? tap_values / 2 : tap_values;
  }

 private:
  NoiseModel model_;
  Readout readout_;
  double read_noise_e_;
  double full_well_e_;  // infinite: none
  bool has_adc_;
  double gain_e_per_dn_ = 1.0, black_level_dn_ = 0.0, max_dn_ = 0.0;
};

}  // namespace tofsmith

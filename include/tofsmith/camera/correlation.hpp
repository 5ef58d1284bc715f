// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

/// The correlation function of one demodulation and one modulation function, for real depth:
///   chi(u) = integral over the period of (h_d * d)(t) (h_m * m)(t - u) dt,  u in periods.
/// Without impulse responses it is piecewise linear and kept exactly by its corners; with them it
/// is smooth and kept by its harmonics D_n Hd_n conj(M_n Hm_n).
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (3)
class CorrelationFunction {
 public:
  /// Without impulse responses.
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation);
  /// With `transfer` = Hd_n conj(Hm_n), n = 0 .. as many harmonics as are to be kept.
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation,
                      const Eigen::VectorXcd& transfer);

  /// Value at depth `u` [periods]; any real u, period 1.
  double operator()(double u) const;
  /// Values at u = j / points, j = 0 .. points - 1.
  Eigen::VectorXd table(int points) const;

 private:
  std::vector<double> corners_;  // positions in [0, 1), sorted; empty when harmonics are kept
  std::vector<double> values_;   // at the corners
  Eigen::VectorXcd harmonics_;
};

}  // namespace tofsmith

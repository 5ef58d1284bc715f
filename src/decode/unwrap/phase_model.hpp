// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// How a code of sinusoids measures one phase per frequency. Correlation functions are single
/// harmonics, chi_i(u) = c_i + 2 Re(C_i e^(2 pi i f_i u)) for a depth of u periods, so that
///   y_i = T_i (S c_i + A kappa_i) + 2 T_i Re(C_i q_f),   q_f = S e^(2 pi i f u)
/// is linear in the phasors q_f and in the offset. Both are found together, by least squares
/// without weights: a frequency with three or more even steps so has its own offset, and what a
/// quadrature pair lacks comes from the others, because T (S c + A kappa) is one vector up to a
/// factor where every modulation has the same mean (c is then a multiple of kappa), and the span of
/// two where not. What the camera does to amplitude and phase of a frequency is in C.
class PhaseModel {
 public:
  /// @throws std::invalid_argument if a correlation function is no single harmonic (up to
  ///         `largest_other_energy`, a share of its variance), if a frequency is not seen in two
  ///         phases, if the offset is unknown, or if the frequencies share a divisor
  PhaseModel(const DecodingTable& table, double largest_other_energy);

  /// Ascending, in multiples of f0.
  const std::vector<int>& frequencies() const { return frequencies_; }
  int count() const { return static_cast<int>(frequencies_.size()); }

  /// The phasors (count) of a pixel's electrons - dark (K).
  void phasors(const double* electrons, std::complex<double>* phasor) const;
  /// What one electron in measurement k adds to phasor j [1/s].
  std::complex<double> gain(int j, int k) const { return gain_(j, k); }

 private:
  std::vector<int> frequencies_;
  Eigen::MatrixXcd gain_;  // (frequencies, K)
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Measurement of one phase per frequency by a code of sinusoids,
///   chi_i(u) = c_i + 2 Re(C_i e^(2 pi i f_i u))
/// for a depth of u periods, so that
///   y_i = T_i (S c_i + A kappa_i) + 2 T_i Re(C_i q_f),   q_f = S e^(2 pi i f u)
/// is linear in the phasors q_f and in the offset. Unweighted least squares determine both: three
/// or more equally spaced phases determine their own offset; a quadrature pair uses the offset of
/// other frequencies. The offset T (S c + A kappa) is known up to a factor if all modulations have
/// the same mean; otherwise it lies in the span of two vectors.
class PhaseModel {
 public:
  /// @throws std::invalid_argument if a correlation function is not a single harmonic (up to
  ///   `largest_other_energy`, relative to its variance), if a frequency is measured at fewer than
  ///   two phases, if the offset is not determined, or if the frequencies share a divisor
  PhaseModel(const DecodingTable& table, double largest_other_energy);

  /// Frequencies in multiples of f0, ascending.
  const std::vector<int>& frequencies() const { return frequencies_; }
  int count() const { return static_cast<int>(frequencies_.size()); }

  /// Computes the phasors (count) of electrons without dark electrons (K).
  void phasors(const double* electrons, std::complex<double>* phasor) const;
  /// Derivative of phasor j with respect to measurement k [1/s].
  std::complex<double> gain(int j, int k) const { return gain_(j, k); }

 private:
  std::vector<int> frequencies_;
  Eigen::MatrixXcd gain_;  // (frequencies, K)
};

}  // namespace tofsmith

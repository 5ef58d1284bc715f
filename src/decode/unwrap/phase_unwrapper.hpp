// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

/// Maximum number of frequencies of a code.
inline constexpr int max_frequencies = 32;

/// A candidate depth for each frequency.
struct Wraps {
  double distance = 0.0;                          ///< sum of w_f (z_f - z)^2
  double depth = 0.0;                             ///< weighted mean [periods], any real
  std::array<double, max_frequencies> candidate;  ///< z_f = (phase_f + wraps_f) / f [periods]
};

/// Computes depth from wrapped phases: chooses the candidates that are closest to each other.
class PhaseUnwrapper {
 public:
  /// @param frequencies  in multiples of f0
  /// @param weights      w_f > 0; only their ratios matter
  PhaseUnwrapper(std::vector<int> frequencies, std::vector<double> weights);

  /// Returns the choice with the least weighted distance; an infinite distance if there is none.
  /// @param phase   (count) [periods of the frequency]
  /// @param within  part in which the depth must lie; null: anywhere
  Wraps nearest(const double* phase, const RangePart* within = nullptr) const;

 private:
  std::vector<int> frequencies_;
  std::vector<double> weights_;
  double whole_weight_ = 0.0;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/unwrap/phase_unwrapper.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

PhaseUnwrapper::PhaseUnwrapper(std::vector<int> frequencies, std::vector<double> weights)
    : frequencies_(std::move(frequencies)),
      weights_(std::move(weights)),
      whole_weight_(std::accumulate(weights_.begin(), weights_.end(), 0.0)) {
  TOFSMITH_ASSERT_EQ(frequencies_.size(), weights_.size());
  TOFSMITH_ASSERT_LE(std::ssize(frequencies_), max_frequencies);
}

/// The nearest candidate of frequency f changes where z is half way between two candidates. Between
/// these places the choice is constant, so the minimum over all z is that of one choice at its
/// weighted mean.
Wraps PhaseUnwrapper::nearest(const double* phase, const RangePart* within) const {
  constexpr double just_after = 1e-9;  // [periods]; exceeds the rounding error of places
  Wraps wraps, best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t own = 0; own < frequencies_.size(); ++own)
    for (int wrap = 0; wrap < frequencies_[own]; ++wrap) {
      const double z = (phase[own] + wrap + 0.5) / frequencies_[own] + just_after;
      double sum = 0.0;
      for (std::size_t j = 0; j < frequencies_.size(); ++j) {
        const double f = frequencies_[j];
        wraps.candidate[j] = (phase[j] + std::round(z * f - phase[j])) / f;
        sum += weights_[j] * wraps.candidate[j];
      }
      wraps.depth = sum / whole_weight_;
      wraps.distance = 0.0;
      for (std::size_t j = 0; j < frequencies_.size(); ++j) {
        const double away = wraps.candidate[j] - wraps.depth;
        wraps.distance += weights_[j] * away * away;
      }
      if (wraps.distance < best.distance && (!within || within->contains(wraps.depth)))
        best = wraps;
    }
  return best;
}

}  // namespace tofsmith

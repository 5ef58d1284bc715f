// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/shared/random.hpp"

namespace tofsmith {

/// Points (N, rank) of a closed curve.
using Curve = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Curve random_smooth_curve(int rank, int samples, std::uint64_t seed) {
  RandomStream random(seed, 0);
  Curve curve = Curve::Zero(samples, rank);
  for (int j = 0; j < rank; ++j)
    for (int harmonic = 1; harmonic <= (rank + 2) / 2; ++harmonic) {
      const double cosine = random.normal() / harmonic, sine = random.normal() / harmonic;
      for (int n = 0; n < samples; ++n) {
        const double phase = 2.0 * std::numbers::pi * harmonic * n / samples;
        curve(n, j) += cosine * std::cos(phase) + sine * std::sin(phase);
      }
    }
  return curve;
}

}  // namespace tofsmith

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

/// Every direction `times` times in a row, in lengths that differ.
inline Curve with_plateaus(const Curve& curve, int times) {
  Curve repeated(curve.rows() * times, curve.cols());
  for (Eigen::Index n = 0; n < repeated.rows(); ++n)
    repeated.row(n) = curve.row(n / times) * (1.0 + static_cast<double>(n % times) / 3.0);
  return repeated;
}

/// The whole curve twice, once around.
inline Curve twice_around(const Curve& curve) {
  Curve twice(2 * curve.rows(), curve.cols());
  twice << curve, curve;
  return twice;
}

/// Every fifth bin without contrast, the first ones too.
inline Curve with_gaps(Curve curve) {
  for (Eigen::Index n = 0; n < curve.rows(); n += 5) curve.row(n).setZero();
  curve.topRows(3).setZero();
  return curve;
}

}  // namespace tofsmith

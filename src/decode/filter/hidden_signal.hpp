// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "decode/expected_noise.hpp"

namespace tofsmith {

/// Estimates the signal from its contrast if subtracted buckets hide the light. A signal S with
/// variance f + S m in each of `rank` coordinates yields <|u|^2> = S^2 <p^2> + rank (f + S m). For
/// averages of n measurements, f and m are n times smaller.
struct HiddenSignal {
  HiddenSignal(const ExpectedNoise& noise, const AmbientProjection& projection)
      : rank(static_cast<float>(projection.rank())),
        mean_curve_square(static_cast<float>(projection.curve.rowwise().squaredNorm().mean())) {
    const Eigen::VectorXd share =
        projection.basis.rowwise().squaredNorm() / static_cast<double>(projection.rank());
    shot_share.assign(share.begin(), share.end());
    floor_variance_e2 =
        static_cast<float>(std::max(min_variance_e2, share.dot(noise.floor_variance_e2)));
    shot_per_signal = static_cast<float>((noise.shot_gated * share).mean());
  }

  /// Returns S [e/s] for |u|^2 = `squares` [e^2].
  float of(float squares, float averaged) const {
    const float per_mean = rank / averaged;
    const float m = per_mean * shot_per_signal;
    const float beyond = std::max(0.0f, squares - per_mean * floor_variance_e2);
    return (std::sqrt(m * m + 4 * mean_curve_square * beyond) - m) / (2 * mean_curve_square);
  }

  float rank = 0.0f;
  std::vector<float> shot_share;   ///< mean share of a measurement in a coordinate's variance (K)
  float floor_variance_e2 = 0.0f;  ///< f
  float shot_per_signal = 0.0f;    ///< m, averaged over all depths
  float mean_curve_square = 0.0f;  ///< <p^2>, averaged over all depths
};

}  // namespace tofsmith

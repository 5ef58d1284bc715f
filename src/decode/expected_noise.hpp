// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Variance of measurement k at bin n:
///   S shot_gated(n, k) + A shot_ambient[k] + floor_variance_e2[k].
struct ExpectedNoise {
  explicit ExpectedNoise(const DecodingTable& table);

  RowMajorMatrix shot_gated;          ///< T o shot_chi (N, K)
  Eigen::VectorXd shot_ambient;       ///< T o shot_kappa (K)
  Eigen::VectorXd floor_variance_e2;  ///< without light, or with only hidden ambient light (K)
};

/// Avoids divisions by zero for noiseless tables [e^2].
inline constexpr double min_variance_e2 = 1e-12;

}  // namespace tofsmith

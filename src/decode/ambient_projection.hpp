// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Maximum number of measurements per pixel.
inline constexpr int max_measurements = 64;

/// Residuals below this fraction of the measurements are rounding errors.
inline constexpr double nothing_left = 1e-12;

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Decoding table with ambient light projected out.
struct AmbientProjection {
  explicit AmbientProjection(const DecodingTable& table);

  int rank() const { return static_cast<int>(basis.cols()); }

  Eigen::VectorXd ambient;  ///< a = T o kappa (K); exactly 0 where ambient light cancels
  RowMajorMatrix gated;     ///< x = T o chi (N, K)
  Eigen::MatrixXd basis;    ///< V (K, rank): orthonormal columns that span the rows of P x
  RowMajorMatrix curve;     ///< p = V^T P x (N, rank); exactly 0 where there is no contrast
  /// V for independent noise. For rows, the basis of whitened electrons W y'; then basis = W^T V,
  /// so that q = basis^T y' in all cases.
  Eigen::MatrixXd noise_basis;
};

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

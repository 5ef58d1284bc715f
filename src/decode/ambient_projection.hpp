// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Most measurements of a pixel a decoder takes: bounds the work space it keeps on the stack.
inline constexpr int max_measurements = 64;

/// Below this share of what is measured, its residual without ambient light is rounding.
inline constexpr double nothing_left = 1e-12;

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The part of a decoding table that ambient light cannot explain, in coordinates of the plane
/// (of dimension rank) in which it lies.
struct AmbientProjection {
  explicit AmbientProjection(const DecodingTable& table);

  int rank() const { return static_cast<int>(basis.cols()); }

  Eigen::VectorXd ambient;  ///< a = T o kappa (K); exactly 0 where ambient light cancels
  RowMajorMatrix gated;     ///< x = T o chi (N, K)
  Eigen::MatrixXd basis;    ///< V (K, rank): orthonormal columns that span the rows of P x
  RowMajorMatrix curve;     ///< p = V^T P x (N, rank); exactly 0 where there is no contrast
  /// V itself where the noise of electrons is independent. Of rows the plane is that of whitened
  /// electrons W y', which have the noise of the table: P takes off W a, noise_basis is V, and
  /// basis W^T V, so that q = basis^T y' everywhere.
  Eigen::MatrixXd noise_basis;
};

}  // namespace tofsmith

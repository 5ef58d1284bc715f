// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Scalar products in the decoding subspace, <u, w>_C = u^T C^-1 w, with the covariance C = V^T
/// diag(v) V of q. Allocates nothing.
class NoiseMetric {
 public:
  static constexpr std::size_t max_pairs =
      static_cast<std::size_t>(max_measurements) * (max_measurements + 1) / 2;

  /// @param noise_basis  V (K, rank)
  /// @param plane        q (rank)
  /// @param variance_e2  v (K)
  NoiseMetric(const RowMajorMatrix& noise_basis, const double* plane, const double* variance_e2);

  /// Lower triangle, row by row.
  const double* metric() const { return metric_.data(); }
  /// C^-1 q (rank).
  const double* along() const { return along_.data(); }
  /// |q|_C.
  double length() const { return length_; }
  /// Returns an upper bound on the factor by which small angles grow; infinite if the noise is too
  /// uneven.
  double stretch() const;

  double product(const double* u, const double* w) const;
  /// <q, u>_C.
  double signal(const double* u) const;

 private:
  int rank_;
  std::array<double, max_pairs> metric_;
  std::array<double, max_measurements> along_;
  double length_ = 0.0;
};

}  // namespace tofsmith

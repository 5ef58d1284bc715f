// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// How well every bin explains a pixel, in double: with equal weights or with given ones.
class DepthScores {
 public:
  explicit DepthScores(const AmbientProjection& projection);

  int samples() const { return static_cast<int>(gated_.cols()); }

  /// The lowest of the bins with the best zero-mean normalized cross-correlation, up to rounding.
  /// @param plane  what ambient light leaves of a pixel (rank)
  std::int32_t best_correlation(const double* plane) const;

  /// By how much light from every bin, with ambient light beside it, lowers sum_i weight_i y_i^2;
  /// signal and ambient light are >= 0.
  /// @param electrons  without dark (K)
  /// @param fall       (N)
  void weighted_fall(const double* electrons, const double* weight, double* fall) const;

 private:
  RowMajorMatrix directions_;  // p / |p| (rank, N); 0 without contrast
  RowMajorMatrix gated_;       // x (K, N)
  Eigen::VectorXd ambient_;    // a (K)
};

}  // namespace tofsmith

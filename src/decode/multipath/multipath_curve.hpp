// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Maximum number of dimensions in which returns are separated; minor ones are omitted.
inline constexpr int max_span = 12;
inline constexpr int pixels_per_group = 16;

/// Curve of a decoding table in single precision. Positions are points with finer spacing than
/// bins.
struct MultipathCurve {
  /// @param tail_m  mean delay of the tail [m]; 0: no tail
  MultipathCurve(const DecodingTable& table, const AmbientProjection& projection, double tail_m);

  int measurements = 0;
  int span = 0;    ///< dimensions r without ambient light
  int points = 0;  ///< per period
  int points_per_row = 0;
  int coarse = 0;  ///< places at which pairs are tried first
  bool sees_ambient = false;
  /// Ambient direction if visible, then the decoding subspace, (K, dims()).
  std::vector<float> basis;
  std::vector<float> products;    ///< basis_a basis_b, a >= b, (K, pairs)
  std::vector<float> fine;        ///< p in the subspace, (points + 1, span), last row = first
  std::vector<float> tail;        ///< the same for a tail; empty without tail
  std::vector<float> coarse_row;  ///< every (points / coarse)-th row of `fine`
  std::vector<float> coarse_tail;

  int dims() const { return span + (sees_ambient ? 1 : 0); }
  int pairs() const { return dims() * (dims() + 1) / 2; }
};

/// Returns the number of dimensions with more than 1 % of the size of the main one.
int independent_directions(const AmbientProjection& projection);

/// Interpolates `factor` rows per row: by cubics through four rows, or linearly if that predicts
/// the table's rows better (ideal codes have corners).
RowMajorMatrix drawn_finer(const RowMajorMatrix& table, int factor);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Most dimensions in which returns are separated; those in which a code hardly moves are left
/// out.
inline constexpr int max_span = 12;
/// Pixels that a search takes at a time; a multiple of any vector length used.
inline constexpr int pixels_per_group = 16;

/// The curve of a decoding table as a search for returns needs it: positions are points of a table
/// drawn finer than bins, all in single precision.
struct MultipathCurve {
  /// @param tail_m  mean delay of the tail beside the direct return [m]; 0: there is none
  MultipathCurve(const DecodingTable& table, const AmbientProjection& projection, double tail_m);

  int measurements = 0;
  int span = 0;            ///< dimensions r of the residual without ambient light
  int points = 0;          ///< fine points of a period
  int points_per_row = 0;  ///< of the table
  int coarse = 0;          ///< places at which pairs are tried first
  bool sees_ambient = false;
  /// Columns that expected measurements are made of: the ambient direction if it is seen, then the
  /// plane, (K, dims()).
  std::vector<float> basis;
  std::vector<float> products;    ///< basis_a basis_b, a >= b, (K, pairs)
  std::vector<float> fine;        ///< p in the plane, (points + 1, span), last row = first
  std::vector<float> tail;        ///< the same of a unit tail; empty if there is none
  std::vector<float> coarse_row;  ///< every (points / coarse)-th row of `fine`
  std::vector<float> coarse_tail;

  int dims() const { return span + (sees_ambient ? 1 : 0); }
  int pairs() const { return dims() * (dims() + 1) / 2; }
};

/// Dimensions in which a code on a camera separates returns by more than 1 % of its main one.
int independent_directions(const AmbientProjection& projection);

/// Rows between rows, `factor` for one: by cubics through four rows, or by chords where the table's
/// own rows are foretold better by chords of their neighbours (ideal codes have corners).
RowMajorMatrix drawn_finer(const RowMajorMatrix& table, int factor);

}  // namespace tofsmith

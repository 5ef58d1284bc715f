// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/search/arc_search.hpp"
#include "decode/search/shared/pixel_tile.hpp"
#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

/// Chooses between lobes whose best rows have similar scores. The score of a lobe's best point
/// exceeds that of its best row by at most `slack` |q|. Lobes within this of the best row are
/// refined, and the one with the best point is chosen (the lowest in case of ties).
class CloseLobes {
 public:
  /// Returns none if rows decide: the curve is not smooth, lies on a circle, or never comes closer
  /// to itself than 2.5 times the spacing of rows.
  static std::optional<CloseLobes> of(const AmbientProjection& projection);

  /// Moves the best row of every pixel to the lobe with the best point, except for pixels without a
  /// row (-1).
  void choose(const DirectionTable& directions, const ArcSearch& arcs, PixelTile& tile) const;

 private:
  CloseLobes(const SmoothCurve& curve, double slack);
  double best_score(const double* unit, std::int32_t row) const;

  float slack_;
  DepthPolynomials polynomials_;
  RowMajorMatrix points_;  // p (N, rank)
  RowMajorMatrix slopes_;  // change of p per row
};

}  // namespace tofsmith

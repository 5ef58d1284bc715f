// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/search/arc_search.hpp"
#include "decode/search/shared/pixel_tile.hpp"
#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

/// Chooses between lobes whose best rows score nearly alike. The score of a lobe's best point
/// exceeds that of its best row by at most `slack` |q|, so all lobes whose best rows come that
/// close to the best row are refined, and the one with the best point wins; of equal ones the
/// lowest.
class CloseLobes {
 public:
  /// Returns nothing where rows decide: the curve is not smooth, lies on a circle, or comes nowhere
  /// closer to itself than 2.5 times the distance between rows.
  static std::optional<CloseLobes> of(const AmbientProjection& projection);

  /// Replaces the best row of every pixel in the tile by the best row of the lobe with the best
  /// point. Pixels without a row (-1) keep none.
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

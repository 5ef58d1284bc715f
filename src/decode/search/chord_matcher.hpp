// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "decode/search/arc_search.hpp"
#include "decode/search/bin_matcher.hpp"
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

/// Maximum turn between bins [rad] for which the best point on chords is adjacent to the best bin.
inline constexpr double coarse_turn_rad = 10.0 * std::numbers::pi / 180.0;

/// Larger turns are jumps, e.g. the falling edge of a ramp; no pixel lies between the ends.
inline constexpr double jump_turn_rad = 75.0 * std::numbers::pi / 180.0;

/// Finds the row next to the depth of a pixel: the row with the best score, with two exceptions:
///   - Parts of smooth curves may be so close that the best row and the best point between rows
///     belong to different lobes (see CloseLobes).
///   - Both ends of the best chord of a coarse table may have a lower score than another row. Such
///     chords are searched in pieces, and the end next to the best piece is returned.
class ChordMatcher {
 public:
  ChordMatcher(const DecodingTable& table, const AmbientProjection& projection,
               bool for_few = false);

  const BinMatcher& bins() const { return rows_; }
  bool has_close_lobes() const { return close_lobes_.has_value(); }
  bool is_coarse() const { return pieces_.has_value(); }
  /// The matcher in use: bins(), or that of the points of a coarse table.
  const BinMatcher& points() const { return pieces_ ? *pieces_->matcher : rows_; }
  /// Closer end of the chord of each point of a coarse table.
  std::span<const std::int32_t> bin_of_point() const {
    return pieces_ ? std::span<const std::int32_t>(pieces_->bin_of_point)
                   : std::span<const std::int32_t>();
  }

  void match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
             PixelTile& tile) const;
  void match_plane(PixelTile& tile) const;
  /// As match(), without pieces of chords.
  void match_bins(const RawView& view, std::int64_t first, int pixels, PixelTile& tile) const;
  void match_plane_bins(PixelTile& tile) const;

 private:
  struct Pieces {
    Pieces(const DecodingTable& table, const AmbientProjection& projection,
           const Eigen::VectorXd& turn_rad, bool for_few);
    std::vector<std::int32_t> bin_of_point;
    std::optional<BinMatcher> matcher;
  };
  void choose_lobes(PixelTile& tile) const;
  void to_bins(PixelTile& tile) const;

  std::optional<CloseLobes> close_lobes_;
  BinMatcher rows_;
  std::optional<Pieces> pieces_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "decode/search/bin_matcher.hpp"
#include "decode/search/close_lobes.hpp"

namespace tofsmith {

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

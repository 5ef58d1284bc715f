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

/// Maximum turn of a table between adjacent bins [rad] for which the best point on its chords is
/// adjacent to the best bin.
inline constexpr double coarse_turn_rad = 10.0 * std::numbers::pi / 180.0;

/// Larger turns are jumps, e.g. the falling edge of a ramp: no pixel is assumed to lie between the
/// ends.
inline constexpr double jump_turn_rad = 75.0 * std::numbers::pi / 180.0;

/// Finds the row of the table next to the depth of a pixel. Usually this is the row with the best
/// score. There are two exceptions:
///   - Smooth curves with parts so close to each other that the best row may belong to a different
///     lobe than the best point between rows (see CloseLobes).
///   - Tables of unknown course between rows that turn by large angles between rows, so that both
///     ends of the best chord may have a lower score than another row. Long chords are searched in
///     pieces, and the end next to the best piece is returned.
class ChordMatcher {
 public:
  /// @param for_few  see BinMatcher
  ChordMatcher(const DecodingTable& table, const AmbientProjection& projection,
               bool for_few = false);

  /// Matches all rows.
  const BinMatcher& bins() const { return rows_; }
  /// Returns true if choosing the lobe requires the best points between rows.
  bool has_close_lobes() const { return close_lobes_.has_value(); }
  bool is_coarse() const { return pieces_.has_value(); }
  /// Returns the matcher in use: bins(), or that of the points of a coarse table.
  const BinMatcher& points() const { return pieces_ ? *pieces_->matcher : rows_; }
  /// Closer end of the chord of each point of a coarse table; empty otherwise.
  std::span<const std::int32_t> bin_of_point() const {
    return pieces_ ? std::span<const std::int32_t>(pieces_->bin_of_point)
                   : std::span<const std::int32_t>();
  }

  void match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
             PixelTile& tile) const;
  void match_plane(PixelTile& tile) const;
  /// As match(), without pieces of chords: the best rows of the best lobes.
  void match_bins(const RawView& view, std::int64_t first, int pixels, PixelTile& tile) const;
  void match_plane_bins(PixelTile& tile) const;

 private:
  struct Pieces {
    Pieces(const DecodingTable& table, const AmbientProjection& projection,
           const Eigen::VectorXd& turn_rad, bool for_few);
    std::vector<std::int32_t> bin_of_point;  ///< closer end of the chord of each point
    std::optional<BinMatcher> matcher;
  };
  void choose_lobes(PixelTile& tile) const;
  void to_bins(PixelTile& tile) const;

  std::optional<CloseLobes> close_lobes_;
  BinMatcher rows_;
  std::optional<Pieces> pieces_;
};

}  // namespace tofsmith

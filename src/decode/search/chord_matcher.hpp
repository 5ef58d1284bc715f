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

/// The most that a table may turn from one bin to the next [rad] for the best point on its chords
/// to lie beside the best bin.
inline constexpr double coarse_turn_rad = 10.0 * std::numbers::pi / 180.0;

/// Beyond, a table jumps, as a ramp does where it falls back: no pixel is sought between the ends.
inline constexpr double jump_turn_rad = 75.0 * std::numbers::pi / 180.0;

/// Finds the row of the table next to which a pixel's depth lies. Usually this is the row with the
/// best score. There are two exceptions:
///   - Parts of a smooth curve come so close to each other that the best row may belong to another
///     lobe than the best point between rows (CloseLobes).
///   - A table of unknown course between its rows turns far from row to row, so that both ends of
///     the best chord may score worse than a row elsewhere. Long chords are searched in pieces, and
///     the end next to the best piece is taken.
class ChordMatcher {
 public:
  /// @param for_few  as of BinMatcher
  ChordMatcher(const DecodingTable& table, const AmbientProjection& projection,
               bool for_few = false);

  /// Matches all rows.
  const BinMatcher& bins() const { return rows_; }
  /// Returns whether choosing the lobe requires the best points between rows.
  bool has_close_lobes() const { return close_lobes_.has_value(); }
  bool is_coarse() const { return pieces_.has_value(); }
  /// What matches: bins(), or of a coarse table its points.
  const BinMatcher& points() const { return pieces_ ? *pieces_->matcher : rows_; }
  /// The closer end of the chord of each point of a coarse table; otherwise empty.
  std::span<const std::int32_t> bin_of_point() const {
    return pieces_ ? std::span<const std::int32_t>(pieces_->bin_of_point)
                   : std::span<const std::int32_t>();
  }

  /// As BinMatcher's.
  void match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
             PixelTile& tile) const;
  void match_plane(PixelTile& tile) const;
  /// The same without pieces of chords: the best rows, in the best lobes.
  void match_bins(const RawView& view, std::int64_t first, int pixels, PixelTile& tile) const;
  void match_plane_bins(PixelTile& tile) const;

 private:
  /// A curve with points between the bins of long chords.
  struct Pieces {
    Pieces(const DecodingTable& table, const AmbientProjection& projection,
           const Eigen::VectorXd& turn_rad, bool for_few);
    std::vector<std::int32_t> bin_of_point;  ///< the end of its chord that is closer
    std::optional<BinMatcher> matcher;
  };
  void choose_lobes(PixelTile& tile) const;
  void to_bins(PixelTile& tile) const;

  std::optional<CloseLobes> close_lobes_;
  BinMatcher rows_;
  std::optional<Pieces> pieces_;
};

}  // namespace tofsmith

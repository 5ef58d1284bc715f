// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/chord_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

namespace {

/// Maximum turn of a piece of a long chord.
constexpr double piece_turn_rad = 2.5 * std::numbers::pi / 180.0;

double furthest_of(const Eigen::VectorXd& turn_rad) {
  return (turn_rad.array() <= jump_turn_rad).select(turn_rad, 0.0).maxCoeff();
}

}  // namespace

double furthest_turn_rad(const DecodingTable& table) {
  const AmbientProjection projection(table);
  return depth_polynomials(projection.curve) ? 0.0 : furthest_of(turns_of(projection.curve));
}

ChordMatcher::Pieces::Pieces(const DecodingTable& table, const AmbientProjection& projection,
                             const Eigen::VectorXd& turn_rad, bool for_few) {
  const RowMajorMatrix& curve = projection.curve;
  const RowMajorMatrix units = curve.rowwise().normalized();
  const auto samples = static_cast<std::int32_t>(curve.rows());
  std::vector<Eigen::RowVectorXd> points;
  for (std::int32_t n = 0; n < samples; ++n) {
    points.push_back(curve.row(n));
    bin_of_point.push_back(n);
    const double turn = turn_rad[n];
    if (!(turn > coarse_turn_rad && turn <= jump_turn_rad)) continue;
    const std::int32_t next = n + 1 < samples ? n + 1 : 0;
    const double from = curve.row(n).norm(), to = curve.row(next).norm();
    const int pieces = static_cast<int>(std::ceil(turn / piece_turn_rad));
    for (int i = 1; i < pieces; ++i) {
      // Equal angles, by the law of sines.
      const double angle = turn * i / pieces;
      const double across = from * std::sin(angle), beyond = to * std::sin(turn - angle);
      const double t = across / (across + beyond);
      const Eigen::RowVectorXd point = (1.0 - t) * curve.row(n) + t * curve.row(next);
      if (is_passed_slowly(point.normalized(), turn, units, turn_rad)) continue;
      points.push_back(point);
      bin_of_point.push_back(t < 0.5 ? n : next);
    }
  }
  AmbientProjection cut = projection;
  cut.curve.resize(std::ssize(points), curve.cols());
  for (std::size_t i = 0; i < points.size(); ++i)
    cut.curve.row(static_cast<Eigen::Index>(i)) = points[i];
  matcher.emplace(table, cut, for_few);
}

ChordMatcher::ChordMatcher(const DecodingTable& table, const AmbientProjection& projection,
                           bool for_few)
    : close_lobes_(CloseLobes::of(projection)),
      rows_(table, projection, for_few || close_lobes_.has_value()) {
  const Eigen::VectorXd turn_rad = turns_of(projection.curve);
  if (furthest_of(turn_rad) > coarse_turn_rad && !depth_polynomials(projection.curve))
    pieces_.emplace(table, projection, turn_rad, for_few);
}

void ChordMatcher::match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
                         PixelTile& tile) const {
  points().match(view, first, pixels, for_outputs, tile);
  choose_lobes(tile);
  to_bins(tile);
}

void ChordMatcher::match_plane(PixelTile& tile) const {
  points().match_plane(tile);
  choose_lobes(tile);
  to_bins(tile);
}

void ChordMatcher::match_bins(const RawView& view, std::int64_t first, int pixels,
                              PixelTile& tile) const {
  rows_.match(view, first, pixels, false, tile);
  choose_lobes(tile);
}

void ChordMatcher::match_plane_bins(PixelTile& tile) const {
  rows_.match_plane(tile);
  choose_lobes(tile);
}

void ChordMatcher::choose_lobes(PixelTile& tile) const {
  if (close_lobes_) close_lobes_->choose(rows_.directions(), rows_.arcs(), tile);
}

void ChordMatcher::to_bins(PixelTile& tile) const {
  if (!pieces_) return;
  for (int i = 0; i < tile.pixels; ++i)
    if (tile.bin[i] >= 0)
      tile.bin[i] = pieces_->bin_of_point[static_cast<std::size_t>(tile.bin[i])];
}

}  // namespace tofsmith

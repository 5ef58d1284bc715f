// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/chord_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {

/// Chords that turn further than coarse_turn_rad are cut into pieces of at most this.
constexpr double piece_turn_rad = 2.5 * std::numbers::pi / 180.0;

/// Where a bin is as close as this, which the curve passes at no more than half the turn, depth is
/// far more likely there.
constexpr double same_direction_rad = 1.0 * std::numbers::pi / 180.0;

bool is_passed_slowly(const Eigen::RowVectorXd& unit, double turn, const RowMajorMatrix& units,
                      const Eigen::VectorXd& turn_rad) {
  const Eigen::Index samples = units.rows();
  const Eigen::VectorXd score = units * unit.transpose();
  for (Eigen::Index n = 0; n < samples; ++n)
    if (score[n] > std::cos(same_direction_rad) &&
        std::max(turn_rad[n], turn_rad[n > 0 ? n - 1 : samples - 1]) <= 0.5 * turn)
      return true;
  return false;
}

double furthest_of(const Eigen::VectorXd& turn_rad) {
  return (turn_rad.array() <= jump_turn_rad).select(turn_rad, 0.0).maxCoeff();
}

}  // namespace

Eigen::VectorXd turns_of(const RowMajorMatrix& curve) {
  const Eigen::Index samples = curve.rows();
  Eigen::VectorXd turn_rad(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const auto from = curve.row(n), to = curve.row((n + 1) % samples);
    const double lengths = from.norm() * to.norm();
    turn_rad[n] = lengths > 0.0 ? std::acos(std::clamp(from.dot(to) / lengths, -1.0, 1.0)) : 0.0;
  }
  return turn_rad;
}

double furthest_turn_rad(const DecodingTable& table) {
  return furthest_of(turns_of(AmbientProjection(table).curve));
}

ChordMatcher::Pieces::Pieces(const DecodingTable& table, const AmbientProjection& projection,
                             const Eigen::VectorXd& turn_rad, bool for_few) {
  const RowMajorMatrix& curve = projection.curve;
  const RowMajorMatrix units = curve.rowwise().normalized();
  const auto samples = static_cast<std::int32_t>(curve.rows());
  std::vector<Eigen::RowVectorXd> points;
  for (std::int32_t n = 0; n < samples; ++n) {
    point_of_bin.push_back(static_cast<std::int32_t>(points.size()));
    points.push_back(curve.row(n));
    bin_of_point.push_back(n);
    const double turn = turn_rad[n];
    if (!(turn > coarse_turn_rad && turn <= jump_turn_rad)) continue;
    const std::int32_t next = n + 1 < samples ? n + 1 : 0;
    const double from = curve.row(n).norm(), to = curve.row(next).norm();
    const int pieces = static_cast<int>(std::ceil(turn / piece_turn_rad));
    for (int i = 1; i < pieces; ++i) {
      // At equal angles: the chord is a side of the triangle of both ends and 0.
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
    : bins_(table, projection, for_few) {
  const Eigen::VectorXd turn_rad = turns_of(projection.curve);
  if (furthest_of(turn_rad) > coarse_turn_rad)
    pieces_.emplace(table, projection, turn_rad, for_few);
}

void ChordMatcher::match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
                         PixelTile& tile) const {
  if (!pieces_) return bins_.match(view, first, pixels, for_outputs, tile);
  pieces_->matcher->match(view, first, pixels, for_outputs, tile);
  to_bins(tile);
}

void ChordMatcher::match_plane(PixelTile& tile) const {
  if (!pieces_) return bins_.match_plane(tile);
  pieces_->matcher->match_plane(tile);
  to_bins(tile);
}

void ChordMatcher::find_second_peaks(PixelTile& tile) const {
  if (!pieces_) return bins_.find_second_peaks(tile);
  for (int i = 0; i < tile.pixels; ++i)
    if (tile.bin[i] >= 0)
      tile.bin[i] = pieces_->point_of_bin[static_cast<std::size_t>(tile.bin[i])];
  pieces_->matcher->find_second_peaks(tile);
  to_bins(tile);
  for (int i = 0; i < tile.pixels; ++i)
    if (tile.second_peak[i] >= 0)
      tile.second_peak[i] = pieces_->bin_of_point[static_cast<std::size_t>(tile.second_peak[i])];
}

void ChordMatcher::to_bins(PixelTile& tile) const {
  for (int i = 0; i < tile.pixels; ++i)
    if (tile.bin[i] >= 0)
      tile.bin[i] = pieces_->bin_of_point[static_cast<std::size_t>(tile.bin[i])];
}

}  // namespace tofsmith

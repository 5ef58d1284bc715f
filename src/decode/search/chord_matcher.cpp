// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/chord_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "decode/search/smooth_curve.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr int max_lobes = 64;
/// Rows decide if the curve stays this many row spacings away from itself. The squared offsets of
/// rows from the best points then differ by less than 1 / 25 of the squared distance of the lobes.
constexpr double far_apart = 2.5;
constexpr Eigen::Index max_examined = 4096;

/// Returns true if the curve comes closer to itself than `distance`, except along the run of
/// decreasing scores around each row.
/// @param spacing  largest distance between neighbouring rows
bool comes_closer(const RowMajorMatrix& units, double distance, double spacing) {
  const Eigen::Index rows = units.rows();
  const Eigen::Index step = (rows + max_examined - 1) / max_examined;
  const double limit = 1.0 - 0.5 * distance * distance;
  for (Eigen::Index n = 0; n < rows; n += step) {
    const auto score = [&](Eigen::Index i) {
      return units.row(n).dot(units.row(i < rows ? i : i - rows));
    };
    // Follows the run to the first row at the distance. Returns true if the curve turns back first.
    Eigen::Index first = n + 1, last = n + rows - 1;
    const auto turns_back = [&](Eigen::Index& row, int direction) {
      double before = score(n);
      for (double now; first < last && (now = score(row)) > limit; row += direction, before = now)
        if (now > before) return true;
      return false;
    };
    if (turns_back(first, 1) || turns_back(last, -1)) return true;
    // Skip rows within which the curve cannot come close.
    while (first < last) {
      const double now = score(first);
      if (now > limit) return true;
      const double away = std::sqrt(std::max(0.0, 2.0 - 2.0 * now));
      first += std::max<Eigen::Index>(1, static_cast<Eigen::Index>((away - distance) / spacing));
    }
  }
  return false;
}

/// Maximum difference between the scores of a best point and of adjacent rows, relative to |q|.
double slack_of(const RowMajorMatrix& units) {
  const Eigen::Index rows = units.rows();
  double second_difference = 0.0;
  for (Eigen::Index n = 0; n < rows; ++n)
    second_difference = std::max(
        second_difference,
        (units.row((n + 1) % rows) - 2.0 * units.row(n) + units.row((n + rows - 1) % rows)).norm());
  constexpr double margin = 1.1;  // for the second derivative by differences
  return margin * second_difference / 8.0;
}

}  // namespace

std::optional<CloseLobes> CloseLobes::of(const AmbientProjection& projection) {
  // On a circle, intersecting lobes have the same shape; rows favour slowly passed lobes.
  if (projection.rank() < 3) return std::nullopt;
  const std::optional<SmoothCurve> curve = finely_sampled_curve(projection.curve);
  if (!curve) return std::nullopt;
  const RowMajorMatrix units = projection.curve.rowwise().normalized();
  const double spacing = turns_of(projection.curve).maxCoeff();
  if (!comes_closer(units, far_apart * spacing, spacing)) return std::nullopt;
  return CloseLobes(*curve, slack_of(units));
}

CloseLobes::CloseLobes(const SmoothCurve& curve, double slack)
    : slack_(static_cast<float>(slack)),
      polynomials_(curve),
      points_(curve.points(0.0)),
      slopes_(curve.slopes(0.0)) {}

/// Score of the best point around a row, on the cubic through points and slopes of both rows.
double CloseLobes::best_score(const double* unit, std::int32_t row) const {
  using Vector = Eigen::Map<const Eigen::RowVectorXd>;
  const Vector q(unit, points_.cols());
  const double t = DepthPolynomials::maximum(q.dot(polynomials_.slope.row(row)),
                                             q.dot(polynomials_.bend.row(row)),
                                             q.dot(polynomials_.asymmetry.row(row)));
  const auto rows = static_cast<std::int32_t>(points_.rows());
  const std::int32_t from = t < 0.0 ? (row > 0 ? row - 1 : rows - 1) : row;
  const std::int32_t to = from + 1 < rows ? from + 1 : 0;
  const double s = t < 0.0 ? 1.0 + t : t;
  const double to_weight = s * s * (3.0 - 2.0 * s), slope_weight = s * (1.0 - s);
  const auto blend = [&](auto&& use) {
    return (1.0 - to_weight) * use(points_, from) + to_weight * use(points_, to) +
           slope_weight * ((1.0 - s) * use(slopes_, from) - s * use(slopes_, to));
  };
  double length2 = 0.0;
  for (Eigen::Index j = 0; j < points_.cols(); ++j) {
    const double p = blend([&](const RowMajorMatrix& m, std::int32_t n) { return m(n, j); });
    length2 += p * p;
  }
  const double along =
      blend([&](const RowMajorMatrix& m, std::int32_t n) { return q.dot(m.row(n)); });
  return along / std::sqrt(length2);
}

void CloseLobes::choose(const DirectionTable& directions, const ArcSearch& arcs,
                        PixelTile& tile) const {
  const int rank = directions.rank();
  std::array<std::int32_t, max_lobes> lobes;
  std::array<double, max_measurements> unit;
  std::array<float, max_measurements> unit_in_float;
  for (int i = 0; i < tile.pixels; ++i) {
    if (tile.bin[i] < 0) continue;
    double length2 = 0.0;
    for (int j = 0; j < rank; ++j) {
      const double q = tile.plane[j * pixels_per_tile + i];
      unit[static_cast<std::size_t>(j)] = q;
      length2 += q * q;
    }
    if (!(length2 > 0.0) || !std::isfinite(length2)) continue;
    for (int j = 0; j < rank; ++j) {
      unit[static_cast<std::size_t>(j)] /= std::sqrt(length2);
      unit_in_float[static_cast<std::size_t>(j)] =
          static_cast<float>(unit[static_cast<std::size_t>(j)]);
    }
    const int count = arcs.near_peaks(unit_in_float.data(), slack_, max_lobes, lobes.data());
    std::sort(lobes.begin(), lobes.begin() + count);
    double best = -1.0;
    std::int32_t chosen = tile.bin[i];
    for (int lobe = 0; lobe < count; ++lobe) {
      const std::int32_t row = lobes[static_cast<std::size_t>(lobe)];
      const double score = best_score(unit.data(), row);
      if (score > best + tie_tolerance) {
        best = score;
        chosen = row;
      }
    }
    // Single precision may shift a peak by one row.
    if (std::abs(circular_difference(chosen, tile.bin[i], directions.samples())) > 1)
      tile.bin[i] = chosen;
  }
}

namespace {

/// Maximum turn of a piece of a long chord.
constexpr double piece_turn_rad = 2.5 * std::numbers::pi / 180.0;

double furthest_of(const Eigen::VectorXd& turn_rad) {
  return (turn_rad.array() <= jump_turn_rad).select(turn_rad, 0.0).maxCoeff();
}

}  // namespace

double furthest_turn_rad(const DecodingTable& table) {
  const AmbientProjection projection(table);
  return finely_sampled_curve(projection.curve) ? 0.0 : furthest_of(turns_of(projection.curve));
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
  if (furthest_of(turn_rad) > coarse_turn_rad && !finely_sampled_curve(projection.curve))
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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/arc_table.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/shared/random.hpp"

namespace tofsmith {

namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();
constexpr std::int32_t rows_between_windows = block_lanes / 2;

Eigen::VectorXd direction_of(const DirectionTable& directions, std::int32_t row) {
  Eigen::VectorXd direction(directions.rank());
  for (int j = 0; j < directions.rank(); ++j) direction[j] = directions.direction(row, j);
  return direction;
}

/// <q, u> <= growth max(<q, u_a>, <q, u_b>, 0) + reach |q|.
struct Bound {
  double growth = 1.0;
  double reach = 0.0;
  void include(const Bound& other) {
    growth = std::max(growth, other.growth);
    reach = std::max(reach, other.reach);
  }
};

/// Bounds u = alpha u_a + beta u_b + e with alpha, beta >= 0 that leave a small e.
Bound bound_of(const Eigen::VectorXd& u, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const auto with = [&](double alpha, double beta) {
    return Bound{std::max(alpha + beta, 1.0), (u - alpha * a - beta * b).norm()};
  };
  const double ab = a.dot(b), ua = u.dot(a), ub = u.dot(b), determinant = 1.0 - ab * ab;
  Bound best = with(0.0, 0.0);
  const auto offer = [&](double alpha, double beta) {
    const Bound offered = with(alpha, beta);
    if (offered.growth + offered.reach < best.growth + best.reach) best = offered;
  };
  offer(std::max(ua, 0.0), 0.0);
  offer(0.0, std::max(ub, 0.0));
  const double alpha = ua - ab * ub, beta = ub - ab * ua;
  if (determinant > 1e-14 && alpha >= 0.0 && beta >= 0.0)
    offer(alpha / determinant, beta / determinant);
  return best;
}

/// Returns the offset of every row: 0, or -infinity if a lower row has the same direction.
std::vector<float> offsets_of_rows(const DirectionTable& directions) {
  constexpr double same = 0.1 * tie_tolerance;
  const std::int32_t samples = directions.samples();
  // Close rows are close along any line.
  Eigen::VectorXd line(directions.rank());
  RandomStream random(1, 0);
  for (double& component : line) component = random.normal();
  line.normalize();
  std::vector<double> along(static_cast<std::size_t>(samples));
  for (std::int32_t n = 0; n < samples; ++n)
    along[static_cast<std::size_t>(n)] = direction_of(directions, n).dot(line);
  std::vector<std::int32_t> order(along.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return along[static_cast<std::size_t>(a)] < along[static_cast<std::size_t>(b)];
  });

  struct Group {
    std::int32_t centre, lowest;
  };
  std::vector<Group> groups;  // sorted along the line
  std::vector<float> offset(along.size(), -float_infinity);
  for (const std::int32_t n : order) {
    const Eigen::VectorXd direction = direction_of(directions, n);
    const auto is_out_of_reach = [&](const Group& group) {
      return along[static_cast<std::size_t>(group.centre)] <
             along[static_cast<std::size_t>(n)] - 2 * same;
    };
    auto group = groups.rbegin();
    while (group != groups.rend() && !is_out_of_reach(*group) &&
           (direction_of(directions, group->centre) - direction).norm() > same)
      ++group;
    if (group == groups.rend() || is_out_of_reach(*group))
      groups.push_back({n, n});
    else
      group->lowest = std::min(group->lowest, n);
  }
  for (const Group& group : groups) offset[static_cast<std::size_t>(group.lowest)] = 0.0f;
  return offset;
}

std::int32_t min_blocks_per_arc(std::int32_t samples) {
  constexpr std::int32_t most = max_bundle_blocks * arcs_per_block * arcs_per_block * block_lanes;
  return (samples + most - 1) / most;
}

float float_above(double value) {
  return std::nextafter(static_cast<float>(value), float_infinity);
}
float float_below(double value) {
  return std::nextafter(static_cast<float>(value), -float_infinity);
}

}  // namespace

KnotLevel::KnotLevel(const DirectionTable& directions, std::int32_t rows_per_arc)
    : rows_per_arc_(rows_per_arc),
      blocks_(0),
      lanes_per_block_(static_cast<std::size_t>(directions.rank()) + 5) {
  const int rank = directions.rank();
  const std::int32_t samples = directions.samples();
  const std::int32_t arcs = (samples + rows_per_arc - 1) / rows_per_arc;
  blocks_ = (arcs + arcs_per_block - 1) / arcs_per_block;
  lanes_.resize(static_cast<std::size_t>(blocks_) * lanes_per_block_);

  const auto row_of_knot = [&](std::int32_t knot) {
    return std::min(knot * rows_per_arc, samples - 1);
  };
  const auto block_of = [&](std::int32_t b) {
    return &lanes_[static_cast<std::size_t>(b) * lanes_per_block_];
  };
  for (std::int32_t b = 0; b < blocks_; ++b) {
    BlockLanes* const lanes = block_of(b);
    BlockLanes* const bounds = lanes + 1 + rank;
    for (int i = 0; i < block_lanes; ++i) {
      const std::int32_t knot = b * arcs_per_block + i;
      lanes[0].lane[i] = knot <= arcs ? 0.0f : -float_infinity;
      for (int j = 0; j < rank; ++j)
        lanes[1 + j].lane[i] = static_cast<float>(directions.direction(row_of_knot(knot), j));
      bounds[0].lane[i] = bounds[2].lane[i] = 1.0f;
      bounds[1].lane[i] = bounds[3].lane[i] = -float_infinity;
    }
    for (int i = 0; i < arcs_per_block; ++i) {
      const std::int32_t arc = b * arcs_per_block + i;
      if (arc >= arcs) break;
      const Eigen::VectorXd start = direction_of(directions, row_of_knot(arc));
      const Eigen::VectorXd end = direction_of(directions, row_of_knot(arc + 1));
      Bound bound;
      for (std::int32_t n = arc * rows_per_arc; n < std::min((arc + 1) * rows_per_arc, samples);
           ++n)
        bound.include(bound_of(direction_of(directions, n), start, end));
      bounds[0].lane[i] = bounds[2].lane[i + 1] = float_below(1.0 / bound.growth);
      bounds[1].lane[i] = bounds[3].lane[i + 1] = float_above(bound.reach / bound.growth);
    }
  }
}

ArcTable::ArcTable(const DirectionTable& directions)
    : samples_(directions.samples()),
      rank_(directions.rank()),
      lanes_per_block_(static_cast<std::size_t>(rank_) + 1),
      arcs_(directions, min_blocks_per_arc(samples_) * block_lanes),
      bundles_(directions, arcs_.rows_per_arc() * arcs_per_block) {
  const std::vector<float> offset = offsets_of_rows(directions);
  fill_rows(directions, offset);
  fill_windows(directions, offset);
}

void ArcTable::fill_rows(const DirectionTable& directions, const std::vector<float>& offset) {
  rows_.resize(static_cast<std::size_t>(row_blocks()) * lanes_per_block_);
  for (std::int32_t n = 0; n < row_blocks() * block_lanes; ++n) {
    BlockLanes* const lanes = &rows_[static_cast<std::size_t>(n / block_lanes) * lanes_per_block_];
    const int lane = n % block_lanes;
    lanes[0].lane[lane] = n < samples_ ? offset[static_cast<std::size_t>(n)] : -float_infinity;
    for (int j = 0; j < rank_; ++j)
      lanes[1 + j].lane[lane] =
          static_cast<float>(directions.direction(std::min(n, samples_ - 1), j));
  }
}

void ArcTable::fill_windows(const DirectionTable& directions, const std::vector<float>& offset) {
  const std::int32_t windows = 2 * row_blocks() - 1;
  windows_.resize(static_cast<std::size_t>(windows) * lanes_per_block_);
  window_radius_.resize(static_cast<std::size_t>(windows));
  for (std::int32_t w = 0; w < windows; ++w) {
    BlockLanes* const lanes = &windows_[static_cast<std::size_t>(w) * lanes_per_block_];
    const std::int32_t first = w * rows_between_windows;
    const Eigen::VectorXd middle =
        direction_of(directions, std::min(first + rows_between_windows, samples_ - 1));
    double radius = min_window_radius;
    for (int i = 0; i < block_lanes; ++i) {
      const std::int32_t n = first + i;
      lanes[0].lane[i] = n < samples_ ? offset[static_cast<std::size_t>(n)] : -float_infinity;
      const Eigen::VectorXd left = direction_of(directions, std::min(n, samples_ - 1)) - middle;
      for (int j = 0; j < rank_; ++j) lanes[1 + j].lane[i] = static_cast<float>(left[j]);
      radius = std::max(radius, left.norm());
    }
    window_radius_[static_cast<std::size_t>(w)] = float_above(radius);
  }
}

}  // namespace tofsmith

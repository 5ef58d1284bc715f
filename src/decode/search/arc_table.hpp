// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

inline constexpr int block_lanes = 16;
struct alignas(64) BlockLanes {
  float lane[block_lanes];
};

/// Arcs lie between two knots.
inline constexpr int arcs_per_block = block_lanes - 1;

inline constexpr int max_bundle_blocks = 64;

/// Curve of directions u, divided into arcs with equal numbers of rows. A knot is the first row of
/// an arc or the last row of the curve. For every row n of an arc between knots a and b, and any q,
///   <q, u_n> <= growth max(<q, u_a>, <q, u_b>, 0) + reach |q|.
class KnotLevel {
 public:
  KnotLevel(const DirectionTable& directions, std::int32_t rows_per_arc);

  std::int32_t rows_per_arc() const { return rows_per_arc_; }
  int blocks() const { return blocks_; }

  /// Layout [1 + rank + 4][16]: an offset (0, or -infinity for an unused knot), the knots, and 1 /
  /// growth and reach / growth for the arcs that start and that end at a knot, rounded to valid
  /// bounds. Without an arc, reach is -infinity.
  const float* block(int b) const {
    return lanes_[static_cast<std::size_t>(b) * lanes_per_block_].lane;
  }

 private:
  std::int32_t rows_per_arc_;
  int blocks_;
  std::size_t lanes_per_block_;
  std::vector<BlockLanes> lanes_;
};

/// Error bounds of float scores relative to |q|: `per_error` times the error of q and `share` |q|.
/// A score that leads by `lead` is better; scores more than `prune` below the best are excluded.
struct Margins {
  float lead;
  float tie;
  float prune;
};

// To first order, rounding a direction to float and summing rank products changes a score by at
// most (rank + 2) u |q|. The bound of an arc adds at most 1.5 times that, and a few u |q|.
inline Margins margins_of(int rank) {
  constexpr float unit_roundoff = 0.5f * std::numeric_limits<float>::epsilon();
  const float score = static_cast<float>(rank + 2) * unit_roundoff * 1.01f;
  const float bound = 4.0f * static_cast<float>(rank + 4) * unit_roundoff;
  const auto tie = static_cast<float>(2 * tie_tolerance);
  return {2.0f * score, tie, score + bound + tie};
}

class ArcTable {
 public:
  static constexpr double min_window_radius = 1e-3;

  explicit ArcTable(const DirectionTable& directions);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  const KnotLevel& arcs() const { return arcs_; }
  /// Bundles of 15 arcs, each one block of `arcs()`.
  const KnotLevel& bundles() const { return bundles_; }

  /// Blocks of 16 rows per arc: 1, or more for very long curves.
  std::int32_t blocks_per_arc() const { return arcs_.rows_per_arc() / block_lanes; }
  std::int32_t row_blocks() const { return (samples_ + block_lanes - 1) / block_lanes; }

  /// Block of 16 rows, [1 + rank][16]: an offset (0, or -infinity for a repeated direction), then
  /// the directions.
  const float* rows(std::int32_t block) const {
    return rows_[static_cast<std::size_t>(block) * lanes_per_block_].lane;
  }
  /// Windows of 16 rows that start at every 8th row, as rows(), minus the middle row of the window.
  const float* window(std::int32_t w) const {
    return windows_[static_cast<std::size_t>(w) * lanes_per_block_].lane;
  }
  /// Largest length of these differences.
  float window_radius(std::int32_t w) const { return window_radius_[static_cast<std::size_t>(w)]; }
  std::int32_t windows() const { return static_cast<std::int32_t>(window_radius_.size()); }

 private:
  void fill_rows(const DirectionTable& directions, const std::vector<float>& offset);
  void fill_windows(const DirectionTable& directions, const std::vector<float>& offset);

  int samples_;
  int rank_;
  std::size_t lanes_per_block_;  // of rows and windows
  KnotLevel arcs_;
  KnotLevel bundles_;
  std::vector<BlockLanes> rows_;
  std::vector<BlockLanes> windows_;
  std::vector<float> window_radius_;
};

}  // namespace tofsmith

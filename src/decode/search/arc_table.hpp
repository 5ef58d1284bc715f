// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

/// Vectors that are scored together.
inline constexpr int block_lanes = 16;
/// One number for every vector of a block.
struct alignas(64) BlockLanes {
  float lane[block_lanes];
};

/// An arc lies between two knots, so that a block of 16 knots bounds 15 arcs.
inline constexpr int arcs_per_block = block_lanes - 1;

/// Of bundles of arcs; bounds what a search keeps in mind.
inline constexpr int max_bundle_blocks = 64;

/// A curve of directions u as arcs of equally many rows. A knot is the first row of an arc, or the
/// curve's last row. For every row n of an arc between the knots a and b, and any vector q,
///   <q, u_n> <= growth max(<q, u_a>, <q, u_b>, 0) + reach |q|.
class KnotLevel {
 public:
  KnotLevel(const DirectionTable& directions, std::int32_t rows_per_arc);

  std::int32_t rows_per_arc() const { return rows_per_arc_; }
  int blocks() const { return blocks_; }

  /// [1 + rank + 4][16]: an offset (0, or -infinity for no knot), the knots, and for the arc that
  /// starts at a knot, then for the one that ends there: 1 / growth and reach / growth, rounded so
  /// that the bound stays one; reach is -infinity where there is no arc.
  const float* block(int b) const {
    return lanes_[static_cast<std::size_t>(b) * lanes_per_block_].lane;
  }

 private:
  std::int32_t rows_per_arc_;
  int blocks_;
  std::size_t lanes_per_block_;
  std::vector<BlockLanes> lanes_;
};

/// How far float scores may be off, as shares of |q| (in all: `per_error` times the error of q and
/// `share` |q|). `lead` is what proves that one score beats another; pruned is what scores less
/// than the best by more than `prune`.
struct Margins {
  float lead;
  float tie;
  float prune;
};

// Rounding a direction to float and summing rank products, fused or not, moves a score by at most
// (rank + 2) u |q| to first order. The bound of an arc takes at most 1.5 of that from its knots
// (growth), and few u |q| from its own operations.
inline Margins margins_of(int rank) {
  constexpr float unit_roundoff = 0.5f * std::numeric_limits<float>::epsilon();
  const float score = static_cast<float>(rank + 2) * unit_roundoff * 1.01f;
  const float bound = 4.0f * static_cast<float>(rank + 4) * unit_roundoff;
  const auto tie = static_cast<float>(2 * tie_tolerance);
  return {2.0f * score, tie, score + bound + tie};
}

/// Unit directions of a code's curve, laid out for branch and bound over its arcs.
class ArcTable {
 public:
  static constexpr double min_window_radius = 1e-3;

  /// @param blocks_per_arc  of 16 rows, at least; more where the curve is very long
  ArcTable(const DirectionTable& directions, std::int32_t blocks_per_arc);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  const KnotLevel& arcs() const { return arcs_; }
  /// Bundles of 15 arcs, which are a block of `arcs()` each; at most max_bundle_blocks blocks.
  const KnotLevel& bundles() const { return bundles_; }

  /// Blocks of rows in an arc: 1, or more where curves are very long.
  std::int32_t blocks_per_arc() const { return arcs_.rows_per_arc() / block_lanes; }
  std::int32_t row_blocks() const { return (samples_ + block_lanes - 1) / block_lanes; }

  /// 16 rows, [1 + rank][16]: an offset (0, or -infinity for a row that repeats the
  /// direction of a lower one), the directions.
  const float* rows(std::int32_t block) const {
    return rows_[static_cast<std::size_t>(block) * lanes_per_block_].lane;
  }
  /// Windows of 16 rows that start at every 8th row, laid out like rows(): what is left of the
  /// directions without that of the window's middle row.
  const float* window(std::int32_t w) const {
    return windows_[static_cast<std::size_t>(w) * lanes_per_block_].lane;
  }
  /// Length of the longest such remainder, or min_window_radius if that is more.
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

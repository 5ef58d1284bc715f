// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Chords whose ends differ in direction by less are one direction: the square of the sine.
inline constexpr double parallel_chords = 1e-14;

/// Rows whose components stand side by side.
inline constexpr int rows_per_block = 8;

/// Scores tie that are this close, in units of |P y'|: what ambient light does not explain of a
/// pixel, and of which its vector in the plane may be a small part.
inline constexpr double tie_tolerance = 1e-11;

/// Cells prove no bin of a pixel whose error is a larger share of its vector q in the plane,
inline constexpr double max_proven_error = 8e-6;
/// nor of one with more than this in |P y'| / |q|.
inline constexpr double max_proven_residual = 32.0;

/// Unit directions of a code's curve, laid out for search. There is one row per bin, and a last
/// block is filled up. Bins without contrast have no direction: their rows repeat that of another
/// bin, so that no score of theirs is new.
class DirectionTable {
 public:
  explicit DirectionTable(const AmbientProjection& projection);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  int blocks() const { return static_cast<int>(bin_of_row_.size()) / rows_per_block; }

  /// Bin whose direction stands in a row.
  std::int32_t bin_of_row(std::int32_t row) const {
    return bin_of_row_[static_cast<std::size_t>(row)];
  }
  /// Directions of a block, [rank][rows_per_block].
  const double* block(int b) const { return &directions_[static_cast<std::size_t>(b) * stride_]; }
  double direction(std::int32_t row, int j) const {
    return block(row / rows_per_block)[j * rows_per_block + row % rows_per_block];
  }

  /// Of every row, filled up to a whole block.
  std::span<const std::int32_t> bins_by_row() const { return bin_of_row_; }

 private:
  int samples_ = 0;
  int rank_ = 0;
  std::size_t stride_ = 0;  // of a block
  std::vector<std::int32_t> bin_of_row_;
  std::vector<double> directions_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Squared sine below which the ends of a chord have the same direction.
inline constexpr double parallel_chords = 1e-14;

/// Number of rows with interleaved components.
inline constexpr int rows_per_block = 8;

/// Scores within this distance tie, in units of |P y'|, the part of a pixel that ambient light does
/// not explain. Its vector in the decoding subspace may be a small part of that.
inline constexpr double tie_tolerance = 1e-11;

/// Cells do not prove pixels whose error exceeds this fraction of their vector q in the subspace,
inline constexpr double max_proven_error = 8e-6;
/// or whose |P y'| / |q| exceeds this.
inline constexpr double max_proven_residual = 32.0;

/// Unit directions of the curve of a code, arranged for searches: one row per bin, padded to whole
/// blocks. Bins without contrast have no direction; their rows repeat that of another bin.
class DirectionTable {
 public:
  explicit DirectionTable(const AmbientProjection& projection);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  int blocks() const { return static_cast<int>(bin_of_row_.size()) / rows_per_block; }

  std::int32_t bin_of_row(std::int32_t row) const {
    return bin_of_row_[static_cast<std::size_t>(row)];
  }
  /// Directions of a block, [rank][rows_per_block].
  const double* block(int b) const { return &directions_[static_cast<std::size_t>(b) * stride_]; }
  double direction(std::int32_t row, int j) const {
    return block(row / rows_per_block)[j * rows_per_block + row % rows_per_block];
  }

  /// One entry per row, including padding.
  std::span<const std::int32_t> bins_by_row() const { return bin_of_row_; }

 private:
  int samples_ = 0;
  int rank_ = 0;
  std::size_t stride_ = 0;  // of a block
  std::vector<std::int32_t> bin_of_row_;
  std::vector<double> directions_;
};

}  // namespace tofsmith

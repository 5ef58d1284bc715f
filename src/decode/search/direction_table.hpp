// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Squared sine of the angle of parallel chords.
inline constexpr double parallel_chords = 1e-14;

/// Rows with interleaved components.
inline constexpr int rows_per_block = 8;

/// Scores within this distance tie, in units of |P y'|. The vector of a pixel in the decoding
/// subspace may be a small part of P y'.
inline constexpr double tie_tolerance = 1e-11;

/// Cells do not prove pixels whose error exceeds this fraction of their vector q,
inline constexpr double max_proven_error = 8e-6;
/// or whose |P y'| / |q| exceeds this.
inline constexpr double max_proven_residual = 32.0;

/// Unit directions of the curve of a code, padded to whole blocks. Rows of bins without contrast
/// repeat the direction of another bin.
class DirectionTable {
 public:
  explicit DirectionTable(const AmbientProjection& projection);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  int blocks() const { return static_cast<int>(bin_of_row_.size()) / rows_per_block; }

  std::int32_t bin_of_row(std::int32_t row) const {
    return bin_of_row_[static_cast<std::size_t>(row)];
  }
  /// [rank][rows_per_block].
  const double* block(int b) const { return &directions_[static_cast<std::size_t>(b) * stride_]; }
  double direction(std::int32_t row, int j) const {
    return block(row / rows_per_block)[j * rows_per_block + row % rows_per_block];
  }

  /// Includes padding.
  std::span<const std::int32_t> bins_by_row() const { return bin_of_row_; }

 private:
  int samples_ = 0;
  int rank_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::int32_t> bin_of_row_;
  std::vector<double> directions_;
};

/// Returns the lowest row within `tolerance` of each row; zero rows return themselves.
std::vector<std::int32_t> lowest_alike(const RowMajorMatrix& unit, double tolerance);

/// Directions that can be best: of directions that always tie, only the lowest bin's.
struct DistinctDirections {
  explicit DistinctDirections(const DirectionTable& table);

  std::int32_t count() const { return static_cast<std::int32_t>(bin.size()); }
  int rank() const { return static_cast<int>(unit.cols()); }
  std::int32_t next(std::int32_t n) const { return n + 1 < count() ? n + 1 : 0; }

  RowMajorMatrix unit;            ///< (M, rank), by ascending bin
  std::vector<std::int32_t> bin;  ///< (M)
  double shortest_step = 0.0;     ///< between neighbours (cyclic)
};

}  // namespace tofsmith

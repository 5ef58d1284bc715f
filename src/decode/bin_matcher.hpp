// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "decode/block_search.hpp"
#include "decode/raw_scale.hpp"

namespace tofsmith {

/// A tile of pixels, from raw numbers to bins. Its vectors are what is left of a pixel without
/// ambient light, q = V^T P y', as length and unit vector.
struct Tile {
  int pixels = 0;
  double length[pixels_per_tile];                        ///< |q| [e]
  double unit[max_measurements * pixels_per_tile];       ///< [rank][pixels_per_tile]
  float unit_float[max_measurements * pixels_per_tile];  ///< the same, rounded
  std::int32_t bin[pixels_per_tile];                     ///< -1 for an invalid pixel
};

/// The bins whose directions match pixels best, exactly as double arithmetic finds them.
class BinMatcher {
 public:
  BinMatcher(const DecodingTable& table, const AmbientProjection& projection);

  const DirectionTable& directions() const { return directions_; }

  /// Electrons without dark ones of one raw number.
  double electrons(float raw, int measurement) const { return scale_.electrons(raw, measurement); }
  /// @param raw  (pixels, K), pixels in 1 .. pixels_per_tile
  void match(const float* raw, int pixels, Tile& tile) const;

 private:
  using BlockScores = Eigen::Array<double, rows_per_block, 1>;
  void project(const float* raw, Tile& tile) const;
  void normalize(const double* size, Tile& tile) const;
  BlockScores scores(const Tile& tile, int pixel, int block) const;
  int choose_in(const Tile& tile, int pixel, int block) const;
  int choose(const Tile& tile, int pixel) const;

  DirectionTable directions_;
  Eigen::MatrixXd basis_;  // V (K, rank)
  RawScale scale_;
};

}  // namespace tofsmith

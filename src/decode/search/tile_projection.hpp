// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "decode/search/shared/pixel_tile.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Where a tile's raw numbers stand, for the vector code: number k of pixel i at
/// data[i * pixel_stride + k * measurement_stride].
struct TileSource {
  const float* data = nullptr;
  std::ptrdiff_t pixel_stride = 0;        ///< K (interleaved) or 1
  std::ptrdiff_t measurement_stride = 0;  ///< 1 (interleaved) or the distance of planes
};

/// Constants of the projection q = V^T y' from raw numbers, in single precision, as plain memory.
///   q_j = offset_j + sum_k weight_jk d_k,   d_k = raw_k - ratio_k raw_reference
/// The differences d_k take ambient light off before anything is rounded: it is often 100 times the
/// signal. Where it has equal shares, all ratios are 1 and nothing is lost.
struct ProjectionView {
  int measurements = 0;
  int rank = 0;
  int reference = 0;              ///< measurement the others are compared with; its weight is 0
  const float* ratio = nullptr;   ///< (K)
  const float* weight = nullptr;  ///< (rank, K)
  const float* offset = nullptr;  ///< (rank)
  const float* error_of_difference = nullptr;  ///< (K)
  float error_of_reference = 0.0f;
  float error_of_offset = 0.0f;
};

/// From raw numbers to what ambient light does not explain, with a bound on its rounding.
class TileProjection {
 public:
  /// @param min_distance  between directions that the search tells apart by differences of scores
  TileProjection(const DecodingTable& table, const AmbientProjection& projection,
                 double min_distance);

  const ProjectionView& view() const { return view_; }
  /// Error per rounding of a raw number (K).
  std::span<const double> error_per_rounding() const { return error_per_rounding_; }

  /// Fills plane and error of a tile, up to a multiple of 16 pixels. The error is a little more
  /// than rounding needs: if one direction is the best wherever the vector lies within it, its
  /// score leads by more than tie_tolerance |P y'|; and where it is less than max_proven_error |q|,
  /// |P y'| is at most max_proven_residual |q|.
  /// @param first        pixel of the view with which the tile begins
  /// @param pixels       1 .. pixels_per_tile
  /// @param for_outputs  whether `raw` of the tile is filled too, and all of it the same on every
  ///                     processor
  void project(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
               PixelTile& tile) const;

 private:
  std::vector<float> ratio_, weight_, offset_, error_of_difference_;
  std::vector<double> error_per_rounding_;  // of a raw number (K)
  ProjectionView view_;
};

}  // namespace tofsmith

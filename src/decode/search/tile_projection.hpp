// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "decode/search/shared/pixel_tile.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Value k of pixel i is data[i * pixel_stride + k * measurement_stride].
struct TileSource {
  const float* data = nullptr;
  std::ptrdiff_t pixel_stride = 0;        ///< K (interleaved) or 1
  std::ptrdiff_t measurement_stride = 0;  ///< 1 (interleaved) or the distance of planes
};

/// Constants of the projection q = V^T y' from raw values:
///   q_j = offset_j + sum_k weight_jk d_k,   d_k = raw_k - ratio_k raw_reference
/// The differences d_k remove ambient light, which may exceed the signal 100 times, before
/// rounding.
struct ProjectionView {
  int measurements = 0;
  int rank = 0;
  int reference = 0;                           ///< subtracted measurement; its weight is 0
  const float* ratio = nullptr;                ///< (K)
  const float* weight = nullptr;               ///< (rank, K)
  const float* offset = nullptr;               ///< (rank)
  const float* error_of_difference = nullptr;  ///< (K)
  float error_of_reference = 0.0f;
  float error_of_offset = 0.0f;
};

/// Projection of raw values to the subspace, with a bound on the rounding error.
class TileProjection {
 public:
  /// @param min_distance  least distance of directions that the search distinguishes
  TileProjection(const DecodingTable& table, const AmbientProjection& projection,
                 double min_distance);

  const ProjectionView& view() const { return view_; }
  std::span<const double> error_per_rounding() const { return error_per_rounding_; }

  /// Fills plane and error of a tile, up to a multiple of 16 pixels. The error includes a margin
  /// for ties: if one direction is best for all vectors within the error, it leads by more than
  /// tie_tolerance |P y'|. If the error is below max_proven_error |q|, |P y'| is at most
  /// max_proven_residual |q|.
  /// @param first        first pixel of the tile in the view
  /// @param pixels       1 ... pixels_per_tile
  /// @param for_outputs  also fills `raw`; all values are the same on every processor
  void project(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
               PixelTile& tile) const;

 private:
  std::vector<float> ratio_, weight_, offset_, error_of_difference_;
  std::vector<double> error_per_rounding_;
  ProjectionView view_;
};

}  // namespace tofsmith

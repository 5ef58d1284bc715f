// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "decode/output/output_kernel.hpp"
#include "decode/search/chord_matcher.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

/// Linear map of ZNCC from raw values to the subspace without ambient light, q = weight raw +
/// offset [e].
struct PlaneMap {
  Eigen::MatrixXd weight;  ///< (rank, K)
  Eigen::VectorXd offset;  ///< (rank)
};

/// Decoder for Monte Carlo loops. Computes positions only, equal to the results of the method's
/// decoder except for rounding to single precision between bins.
class TrialDecoder {
 public:
  /// @param trials  approximate number of decoded trials
  /// @throws std::invalid_argument if the method does not support the table
  TrialDecoder(DecodeMethod method, DecodingTable table, UnwrapWeights unwrap_weights,
               std::int64_t trials);

  int measurements() const { return measurements_; }
  int samples() const { return samples_; }
  /// The projection that ZNCC decodes; null for other methods.
  const PlaneMap* plane_map() const { return zncc_ ? &zncc_->plane_map : nullptr; }

  /// Decodes tile.plane to positions in [0, N).
  /// @param tile       with `pixels` set and plane filled up to a multiple of 16
  /// @param sub_bin    true: interpolated positions; false: best bins
  /// @param depth_bin  output for pixels_per_tile pixels; NaN where the plane is not finite
  void decode_plane(bool sub_bin, PixelTile& tile, double* depth_bin) const;
  /// Decodes raw values [K][pixels_per_tile].
  void decode_raw(const float* raw, bool sub_bin, PixelTile& tile, double* depth_bin) const;

 private:
  struct Zncc {
    Zncc(const DecodingTable& table, const AmbientProjection& projection, std::int64_t trials);
    PlaneMap plane_map;
    ChordMatcher matcher;
    OutputKernel outputs;
    int rows, bins;
  };
  void positions_of(bool sub_bin, const PixelTile& tile, double* depth_bin) const;

  int measurements_;
  int samples_;
  double bins_per_row_;
  std::unique_ptr<const Zncc> zncc_;
  std::unique_ptr<const DepthDecoder> other_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "decode/output/output_kernel.hpp"
#include "decode/search/chord_matcher.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

/// What ZNCC sees of raw numbers: q = weight raw + offset [e], without ambient light.
struct PlaneMap {
  Eigen::MatrixXd weight;  ///< (rank, K)
  Eigen::VectorXd offset;  ///< (rank)
};

/// The decoder inside a Monte Carlo loop, of any method: no status, no planes but positions, and
/// for ZNCC a way in behind the projection. Its positions are those of the method's decoder up to
/// single precision between bins.
class TrialDecoder {
 public:
  /// @param trials  as many as will be decoded, about
  /// @throws std::invalid_argument if the method cannot decode this table
  TrialDecoder(DecodeMethod method, DecodingTable table, UnwrapWeights unwrap_weights,
               std::int64_t trials);

  int measurements() const { return measurements_; }
  int samples() const { return samples_; }
  /// The projection of raw numbers that alone decides where a pixel is; none but for ZNCC.
  const PlaneMap* plane_map() const { return zncc_ ? &zncc_->plane_map : nullptr; }

  /// Positions in [0, N) of what stands in tile.plane.
  /// @param tile       with `pixels` set, plane filled up to a multiple of 16
  /// @param sub_bin    between bins; else the best bins
  /// @param depth_bin  room for pixels_per_tile; not a number where the plane is not finite
  void decode_plane(bool sub_bin, PixelTile& tile, double* depth_bin) const;
  /// The same of raw numbers [K][pixels_per_tile].
  void decode_raw(const float* raw, bool sub_bin, PixelTile& tile, double* depth_bin) const;

 private:
  struct Zncc {
    Zncc(const DecodingTable& table, const AmbientProjection& projection, std::int64_t trials);
    PlaneMap plane_map;
    ChordMatcher matcher;
    OutputKernel outputs;
    int rows, bins;
    std::int32_t nearest_bin(std::int32_t row) const;
  };
  void positions_of(bool sub_bin, const PixelTile& tile, double* depth_bin) const;

  int measurements_;
  int samples_;
  double bins_per_row_;
  std::unique_ptr<const Zncc> zncc_;
  std::unique_ptr<const DepthDecoder> other_;
};

}  // namespace tofsmith

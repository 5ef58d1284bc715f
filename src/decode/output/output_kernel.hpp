// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_chunk.hpp"
#include "decode/output/residual_model.hpp"
#include "decode/search/shared/bin_records.hpp"
#include "decode/search/shared/pixel_tile.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

/// A tile of pixels with their best bins. Rows have room for pixels_per_tile; what stands past the
/// first `pixels` does not matter. Rows that the wanted planes do not need (see OutputKernel) may
/// be null.
struct MatchedTile {
  int pixels = 0;                           ///< at most pixels_per_tile
  const float* plane = nullptr;             ///< q = V^T y' [e], [rank][pixels_per_tile]; 0 where
                                            ///< the residual without ambient light is rounding
  const float* electrons = nullptr;         ///< without dark ones [e], [K][pixels_per_tile]
  const std::int32_t* bin = nullptr;        ///< of the best score; -1 for an invalid pixel
  const std::uint8_t* saturated = nullptr;  ///< 1 where a measurement is clipped, else 0
  const float* averaged = nullptr;          ///< as in RawView, of the first pixel on
  NoiseRatios noise;
};

/// From best bins to planes, a tile at a time: what PixelModel and store_pixel define, in single
/// precision, for all pixels of a vector at once. Deviates from them in that
///   - depth, signal and ambient light are those of the best point on the chords up to rounding: a
///     depth errs by about 1e-7 / (angle between bins) of a bin, and by its own rounding to float;
///   - the noise of signal is that of the best bin, the noise of depth that of the middle of its
///     quarter of the chord: less than 1 % off on average, more where the noise of bright pixels
///     vanishes at a bin; negative noise of single measurements, which no light makes, is cut off
///     in the sum only;
///   - confidence uses the noise at the best bin. It is 1 where LobeBound proves that other places
///     have a posterior probability of about 1e-5 at most; only other pixels need LobePosterior.
/// A plane's values do not depend on which others are wanted, on the pixels beside it, or on the
/// processor: products and sums are rounded one by one.
class OutputKernel {
 public:
  /// @param only_positions  `write` is not going to be asked for anything: less to prepare
  OutputKernel(const DecodingTable& table, const AmbientProjection& projection,
               const DecodeOptions& options, bool only_positions = false);

  const BinRecords& records() const { return records_; }
  const OutputConstants& constants() const { return constants_; }
  /// One row of LimitLayout per bin.
  const RecordTable& limits() const { return limits_; }
  /// Models of single pixels in double arithmetic; not with only_positions.
  const LobePosterior& posterior() const { return *posterior_; }
  const ResidualModel& residuals() const { return *residuals_; }

  /// Which rows of a tile these planes need besides `plane` and `bin`.
  bool needs_electrons(const DecodedView& planes) const;
  bool needs_confidence(const DecodedView& planes) const;
  bool needs_residuals(const DecodedView& planes) const {
    return planes.residual || (planes.status && constants_.finds_inconsistent);
  }
  bool needs_saturation(const DecodedView& planes) const { return planes.status != nullptr; }

  /// Writes the tile's pixels to the planes that are not null, from their first value on.
  /// @note thread-safe; allocates nothing
  void write(const MatchedTile& tile, const DecodedView& planes) const;
  /// The best points on the chords, or the best bins where `write` would leave depth out, [bin] in
  /// [0, N); not a number without a bin.
  /// @param depth_bin  with room for pixels_per_tile
  void find_positions(const MatchedTile& tile, double* depth_bin) const;

 private:
  void fill_limits(const AmbientProjection& projection);

  BinRecords records_;
  OutputConstants constants_;
  std::optional<LobePosterior> posterior_;  // none: only positions
  std::optional<ResidualModel> residuals_;  // none: only positions
  RecordTable limits_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_chunk.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/search/shared/bin_records.hpp"

namespace tofsmith {

/// A tile of pixels with their best bins, in rows of length pixels_per_tile. Rows that no requested
/// plane needs may be null.
struct MatchedTile {
  int pixels = 0;                           ///< at most pixels_per_tile
  const float* plane = nullptr;             ///< q = V^T y' [e], [rank][pixels_per_tile]; 0 if the
                                            ///< residual is a rounding error
  const float* electrons = nullptr;         ///< without dark electrons [e], [K][pixels_per_tile]
  const std::int32_t* bin = nullptr;        ///< of the best score; -1 for an invalid pixel
  const std::uint8_t* saturated = nullptr;  ///< 1 if a measurement is clipped, else 0
  const float* averaged = nullptr;          ///< as in RawView, from the first pixel on
  NoiseRatios noise;
};

/// Computes planes from best bins as PixelModel and store_pixel(), but vectorized and in single
/// precision. Differences:
///   - A depth has an error of about 1e-7 / (angle between bins) bins, plus its rounding to float.
///   - Noise of signal is that at the best bin; noise of depth is that at the middle of the quarter
///     of the chord. The error is below 1 % on average, and larger if the noise of bright pixels
///     vanishes at a bin. Negative variances become 0 only in the sum.
///   - Confidence uses the noise at the best bin. Only pixels for which LobeBound does not prove a
///     confidence of 1 need LobePosterior.
/// Values do not depend on other planes, on neighbouring pixels or on the processor: each product
/// and sum is rounded.
class OutputKernel {
 public:
  /// @param only_positions  `write` is never called
  OutputKernel(const DecodingTable& table, const AmbientProjection& projection,
               const DecodeOptions& options, bool only_positions = false);

  const BinRecords& records() const { return records_; }
  const OutputConstants& constants() const { return constants_; }
  const RecordTable& limits() const { return limits_; }
  /// In double precision; not available with only_positions.
  const LobePosterior& posterior() const { return *posterior_; }
  const ResidualModel& residuals() const { return *residuals_; }

  OutputSteps steps_for(const DecodedView& planes) const;
  /// Writes the tile to the planes that are not null, from their first value.
  /// @note thread-safe; allocates nothing
  void write(const MatchedTile& tile, const DecodedView& planes) const;
  /// Computes the best points on the chords, or the best bins of pixels without depth [bin], in [0,
  /// N); NaN without a bin.
  /// @param depth_bin  of length pixels_per_tile
  void find_positions(const MatchedTile& tile, double* depth_bin) const;

 private:
  void fill_limits(const AmbientProjection& projection);

  BinRecords records_;
  OutputConstants constants_;
  std::optional<LobePosterior> posterior_;  // none: only positions
  std::optional<ResidualModel> residuals_;  // none: only positions
  RecordTable limits_;
};

/// Writes the values and the status of one pixel, in double precision.
/// @param raw  (K) raw numbers
/// @param at   index of the pixel in the view
void store_pixel(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                 const PixelDecoding& pixel, std::size_t at, const DecodedView& decoded);
/// As above, after computing the residual if a plane needs it.
/// @param electrons  without dark electrons (K)
void store_pixel(const DecodingTable& table, const DecodeOptions& options,
                 const ResidualModel& residuals, const double* electrons, PixelDecoding decoding,
                 const PixelToDecode& pixel, const DecodedView& decoded);
/// Writes the planes that are independent of the depth's position: signal, ambient light,
/// confidence and residual.
/// @param has_depth  false: NaN
void store_light(const PixelDecoding& pixel, bool has_depth, std::size_t at,
                 const DecodedView& decoded);

}  // namespace tofsmith

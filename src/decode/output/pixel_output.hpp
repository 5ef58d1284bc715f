// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "decode/output/pixel_model.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

struct PixelDecoding {
  double depth_row = 0.0;  ///< in rows, [0, samples)
  PixelEstimate estimate;
  double confidence = 0.0;  ///< probability of the main lobe
  PixelResidual residual = {};

  /// @param probability  none: the pixel has no depth
  void set_confidence(std::optional<double> probability) {
    if (probability)
      confidence = *probability;
    else
      *this = {};
  }
};

/// A pixel of a frame, for decoders in double precision.
struct PixelToDecode {
  const float* raw = nullptr;   ///< (K) raw numbers
  double variance_share = 1.0;  ///< relative to a single measurement
  NoiseRatios noise;
  const RangePart* part = nullptr;  ///< null: anywhere
  std::size_t at = 0;               ///< index in the planes
};

/// Writes a pixel with a NaN or infinite measurement.
void store_invalid(std::size_t at, const DecodedView& decoded);

/// @throws InvalidArgument unless raw numbers have this number of measurements
void require_measurements(const RawView& raw, int measurements);

double probability_of(double log_odds);

/// Returns the bin in [0, samples) nearest to a position in [0, samples].
inline std::int32_t nearest_bin(double depth_bin, int samples) {
  return static_cast<std::int32_t>(std::lround(depth_bin)) % samples;
}

/// For fast decoders; slow ones use smaller blocks, to be cancelled sooner.
inline constexpr std::int64_t usual_block_pixels = 16384;

/// Calls `work` for blocks of the pixels of a frame, on all threads.
/// @throws std::invalid_argument if the frame has another number of measurements; Interrupted if
///     `progress` requests it
void for_each_block(const RawView& raw, int measurements, const Progress& progress,
                    const std::function<void(IndexRange pixels)>& work,
                    std::int64_t block_pixels = usual_block_pixels);

/// Raw numbers of a block, (pixels, K).
struct RawBlock {
  const float* values = nullptr;
  std::int64_t pixels = 0;
  const float* averaged = nullptr;  ///< as in RawView, from the first pixel on
  NoiseRatios noise;
  std::int64_t first = 0;  ///< index in the frame of the first pixel

  /// Returns the variance relative to a single measurement.
  double variance_share(std::int64_t i) const { return averaged ? 1.0 / averaged[i] : 1.0; }
  /// @param parts  of the pixels of the frame, or null
  PixelToDecode pixel(std::int64_t i, int measurements, const RangePart* parts) const {
    return {values + i * measurements, variance_share(i), noise.at(averaged ? averaged[i] : 1.0f),
            parts ? parts + first + i : nullptr, static_cast<std::size_t>(i)};
  }
};

/// As for_each_block(), with the raw numbers and planes of a block.
void decode_frame(
    const RawView& raw, const DecodedView& decoded, int measurements, const Progress& progress,
    const std::function<void(const RawBlock& raw, const DecodedView& decoded)>& decode_block,
    std::int64_t block_pixels = usual_block_pixels);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/bin_records.hpp"
#include "decode/pixel_tile.hpp"
#include "tofsmith/decode/decoded_view.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// A tile of pixels with their best bins. Only the first `pixels` of each row are looked at; what
/// the wanted planes do not need (see OutputKernel) may be null.
struct MatchedTile {
  int pixels = 0;                           ///< at most pixels_per_tile
  const float* plane = nullptr;             ///< q = V^T y' [e], [rank][pixels_per_tile]
  const float* electrons = nullptr;         ///< without dark ones [e], [K][pixels_per_tile]
  const std::int32_t* bin = nullptr;        ///< of the best score; -1 for an invalid pixel
  const std::int32_t* rival = nullptr;      ///< best bin outside the main lobe; -1 if there is none
  const std::uint8_t* saturated = nullptr;  ///< 1 where a measurement is clipped, else 0
};

/// From best bins to planes, a tile at a time: PixelModel and store_pixel in single precision, for
/// all pixels of a vector at once. Deviates from them in that
///   - depth, signal and ambient light are those of the best point on the chords up to rounding: a
///     depth errs by about 1e-7 / (angle between bins) of a bin, and by rounding to a float;
///   - noise is that of the best bin (of depth: a quarter of the way along the chord), and negative
///     noise of single measurements, which no light makes, is cut off in the sum only;
///   - confidence takes the normal distribution from a formula that errs by less than 2e-7, and
///     noise per signal at the best bin.
/// A plane's values do not depend on which others are wanted, on the pixels beside it, or on the
/// processor: products and sums are rounded one by one.
class OutputKernel {
 public:
  OutputKernel(const DecodingTable& table, const AmbientProjection& projection,
               const DecodeOptions& options);

  /// Which rows of a tile these planes need besides `plane` and `bin`.
  bool needs_electrons(const DecodedView& planes) const;
  bool needs_rivals(const DecodedView& planes) const;
  bool needs_saturation(const DecodedView& planes) const { return planes.status != nullptr; }

  /// Writes the tile's pixels to the planes that are not null, from their first value on.
  /// @note thread-safe; allocates nothing
  void write(const MatchedTile& tile, const DecodedView& planes) const;

  /// What the kernel's inner part reads.
  struct Constants {
    int samples = 0;
    float bin_m = 0.0f;
    float bin_high_m = 0.0f;  // bin_m = high + low; a bin's number times high is exact
    float bin_low_m = 0.0f;
    float range_m = 0.0f;
    bool sees_ambient = false;
    std::vector<float> ambient_weight;  // a / |a|^2 (K)
    std::vector<float> basis;           // V (K, rank)
    std::vector<float> shot_ambient;    // variance per ambient light (K)
    std::vector<float> floor_noise_e2;  // variance without light (K)
    float most_shot = 0.0f;             // the largest variance per signal
    float most_shot_ambient = 0.0f;     // per ambient light
    float most_floor_e2 = 0.0f;         // and without light
    float low_signal_sigma2 = 0.0f;
    float minimum_confidence = 0.0f;
  };

 private:
  BinRecords records_;
  Constants constants_;
};

}  // namespace tofsmith

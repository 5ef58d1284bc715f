// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

class Decoder;

/// Methods of decoding depth from measurements.
enum class DecodeMethod {
  zncc,        ///< Decoder
  ml,          ///< LikelihoodDecoder
  unwrap,      ///< UnwrapDecoder, for sinusoids
  two_return,  ///< TwoReturnDecoder
  tail,        ///< TailDecoder
};

constexpr auto words_of(DecodeMethod /*any*/) {
  return word_list("zncc", "ml", "unwrap", "two-return", "tail");
}
/// @throws InvalidArgument for other words
inline DecodeMethod parse_decode_method(std::string_view name) {
  return parse_word<DecodeMethod>("method", name);
}

/// Base class of the decoders of all methods. Immutable and thread-safe.
class DepthDecoder {
 public:
  DepthDecoder(const DepthDecoder&) = delete;
  DepthDecoder& operator=(const DepthDecoder&) = delete;
  virtual ~DepthDecoder() = default;

  virtual DecodeMethod method() const = 0;
  virtual const DecodingTable& table() const = 0;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }
  /// Returns true for the methods two_return and tail.
  bool finds_returns() const {
    return method() == DecodeMethod::two_return || method() == DecodeMethod::tail;
  }
  /// Returns the decoder itself for DecodeMethod::zncc, else null.
  virtual const Decoder* correlation_decoder() const { return nullptr; }

  /// Decodes one frame on all threads into the caller's planes, which the class of each method
  /// describes. Allocates no planes.
  /// @param raw      electrons or counts, with as many measurements as the table
  /// @param decoded  of the same size; null planes are skipped
  /// @throws InvalidArgument if the shape does not match
  /// @note the same bits for any number of threads and layout
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const {
    decode_pixels(raw, nullptr, decoded, progress);
  }
  /// As decode(), with only the maxima of the correlation (in other methods: minima of the cost)
  /// within part of the range as candidates, so that depths do not accumulate at its ends. Depths
  /// outside are assumed to be 100 times less frequent. Pixels without a candidate, or outside with
  /// a probability of at least 0.9, are no_return.
  /// @param parts  one per pixel
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const {
    decode_pixels(raw, parts, decoded, progress);
  }
  /// Decodes frame `frame` of a stack into a new image with the usual planes.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Computes positions in [0, N) in double precision, for Monte Carlo loops.
  /// @param measurements  raw numbers (pixels, K)
  /// @param depth_bin     (pixels); NaN if a measurement is NaN or infinite, or without a return
  /// @note single-threaded; allocates nothing per pixel
  virtual void decode_depth_bins(const float* measurements, std::int64_t pixels,
                                 double* depth_bin) const = 0;
  /// Computes the bins in [0, N) nearest to decode_depth_bins(); -1 without a position.
  virtual void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 protected:
  DepthDecoder() = default;
  DepthDecoder(DepthDecoder&&) = default;
  DepthDecoder& operator=(DepthDecoder&&) = default;

 private:
  /// @param parts  null: the whole range
  virtual void decode_pixels(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                             const Progress& progress) const = 0;
};

}  // namespace tofsmith

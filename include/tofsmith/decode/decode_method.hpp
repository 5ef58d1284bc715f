// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "tofsmith/decode/likelihood_decoder.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/decode/unwrap_decoder.hpp"

namespace tofsmith {

/// Methods of decoding depth from measurements.
enum class DecodeMethod {
  zncc,        ///< Decoder
  ml,          ///< LikelihoodDecoder
  unwrap,      ///< UnwrapDecoder, for sinusoids
  two_return,  ///< TwoReturnDecoder
  tail,        ///< TailDecoder
};

inline constexpr std::array all_decode_methods = {DecodeMethod::zncc, DecodeMethod::ml,
                                                  DecodeMethod::unwrap, DecodeMethod::two_return,
                                                  DecodeMethod::tail};

constexpr std::array<std::string_view, 5> words_of(DecodeMethod /*any*/) {
  return {"zncc", "ml", "unwrap", "two-return", "tail"};
}
/// @throws InvalidArgument for other words
inline DecodeMethod parse_decode_method(std::string_view name) {
  return parse_word<DecodeMethod>("method", name);
}

inline constexpr Help decode_method_help{
    "decoder: zncc (zero-mean normalized cross-correlation) or ml (maximum likelihood, slower) "
    "for any code; unwrap for sinusoids; two-return or tail for multipath"};
inline constexpr Help unwrap_weights_help{
    "weights of the frequencies: inverse variance of their depths, or f^2 (classical)"};
inline constexpr OnlyWith unwrap_weights_condition{"method unwrap"};

/// Interface of the decoders of all methods.
class DepthDecoder {
 public:
  DepthDecoder() = default;
  DepthDecoder(const DepthDecoder&) = delete;
  DepthDecoder& operator=(const DepthDecoder&) = delete;
  virtual ~DepthDecoder() = default;

  virtual DecodeMethod method() const = 0;
  virtual const DecodingTable& table() const = 0;
  /// See Decoder.
  virtual void decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const = 0;
  virtual void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                             const Progress& progress = {}) const = 0;
  virtual void decode_depth_bins(const float* measurements, std::int64_t pixels,
                                 double* depth_bin) const = 0;
  virtual void decode_bins(const float* measurements, std::int64_t pixels,
                           std::int32_t* bin) const = 0;
  /// Returns the decoder itself for DecodeMethod::zncc, else null.
  virtual const Decoder* correlation_decoder() const = 0;
};

/// Creates the decoder of a method, with defaults for all other options.
/// @param unwrap_weights  for unwrap
/// @param multipath       for two_return and tail, except for `status_thresholds`
/// @throws InvalidArgument if the method cannot decode this table
std::unique_ptr<const DepthDecoder> make_decoder(
    DecodeMethod method, DecodingTable table, const DecodeOptions& status_thresholds = {},
    UnwrapWeights unwrap_weights = UnwrapWeights::variance, const MultipathOptions& multipath = {});

}  // namespace tofsmith

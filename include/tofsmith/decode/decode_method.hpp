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

/// The ways from measurements to depth.
enum class DecodeMethod {
  zncc,        ///< Decoder: any code
  ml,          ///< LikelihoodDecoder: any code
  unwrap,      ///< UnwrapDecoder: sinusoids of one or more frequencies
  two_return,  ///< TwoReturnDecoder: codes of six independent means or more
  tail,        ///< TailDecoder: codes of five independent means or more
};

inline constexpr std::array all_decode_methods = {DecodeMethod::zncc, DecodeMethod::ml,
                                                  DecodeMethod::unwrap, DecodeMethod::two_return,
                                                  DecodeMethod::tail};

constexpr std::array<std::string_view, 5> words_of(DecodeMethod /*any*/) {
  return {"zncc", "ml", "unwrap", "two-return", "tail"};
}
/// "zncc", "ml", "unwrap", "two-return", "tail".
std::string_view name_of(DecodeMethod method);
/// @throws std::invalid_argument for any other word
DecodeMethod parse_decode_method(std::string_view name);

/// Help texts of options that choose a decoder.
inline constexpr Help decode_method_help{
    "decoder: zncc for any code, ml for any code by maximum likelihood (slower), unwrap for "
    "sinusoids of one or more frequencies; two-return and tail where light comes back twice or "
    "trails off, for codes of many independent means"};
inline constexpr Help unwrap_weights_help{
    "how unwrapping weighs frequencies: by the variance of their depth on this camera, or by f^2, "
    "as is classical"};
inline constexpr OnlyWith unwrap_weights_condition{"method unwrap"};

/// A decoder of any method.
class DepthDecoder {
 public:
  DepthDecoder() = default;
  DepthDecoder(const DepthDecoder&) = delete;
  DepthDecoder& operator=(const DepthDecoder&) = delete;
  virtual ~DepthDecoder() = default;

  virtual DecodeMethod method() const = 0;
  virtual const DecodingTable& table() const = 0;
  /// As Decoder::decode(), decode_depth_bins() and decode_bins().
  virtual void decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const = 0;
  /// As Decoder::decode_within().
  virtual void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                             const Progress& progress = {}) const = 0;
  virtual void decode_depth_bins(const float* measurements, std::int64_t pixels,
                                 double* depth_bin) const = 0;
  virtual void decode_bins(const float* measurements, std::int64_t pixels,
                           std::int32_t* bin) const = 0;
  /// Returns the decoder itself for DecodeMethod::zncc, else null.
  virtual const Decoder* correlation_decoder() const = 0;
};

/// Returns the decoder of a method, with defaults for all other options.
/// @param unwrap_weights  of DecodeMethod::unwrap
/// @param multipath       of DecodeMethod::two_return and tail, except for `status_thresholds`
/// @throws std::invalid_argument if the method cannot decode this table
std::unique_ptr<const DepthDecoder> make_decoder(
    DecodeMethod method, DecodingTable table, const DecodeOptions& status_thresholds = {},
    UnwrapWeights unwrap_weights = UnwrapWeights::variance, const MultipathOptions& multipath = {});

}  // namespace tofsmith

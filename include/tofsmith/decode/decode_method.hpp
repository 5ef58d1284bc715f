// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <variant>

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

/// "zncc", "ml", "unwrap", "two-return", "tail".
std::string_view name_of(DecodeMethod method);
/// @throws std::invalid_argument for any other word
DecodeMethod parse_decode_method(std::string_view name);

/// A decoder of any method: they share table(), decode(), decode_depth_bins() and decode_bins().
using AnyDecoder =
    std::variant<Decoder, LikelihoodDecoder, UnwrapDecoder, TwoReturnDecoder, TailDecoder>;

/// The decoder of a method, with its defaults but for what is given.
/// @param unwrap_weights  of DecodeMethod::unwrap
/// @param multipath       of DecodeMethod::two_return and tail, but for `status_thresholds`
/// @throws std::invalid_argument if the method cannot decode this table
AnyDecoder make_decoder(DecodeMethod method, DecodingTable table,
                        const DecodeOptions& status_thresholds = {},
                        UnwrapWeights unwrap_weights = UnwrapWeights::variance,
                        const MultipathOptions& multipath = {});

}  // namespace tofsmith

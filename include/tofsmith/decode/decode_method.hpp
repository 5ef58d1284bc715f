// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tofsmith/decode/depth_decoder.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/decode/unwrap_decoder.hpp"

namespace tofsmith {

inline constexpr Help decode_method_help{
    "decoder: zncc (zero-mean normalized cross-correlation) or ml (maximum likelihood, slower) "
    "for any code; unwrap for sinusoids; two-return or tail for multipath"};
inline constexpr Help unwrap_weights_help{
    "weights of the frequencies: inverse variance of their depths, or f^2 (classical)"};
inline constexpr OnlyWith unwrap_weights_condition{"method unwrap"};

/// Creates the decoder of a method, with defaults for all other options.
/// @param unwrap_weights  for unwrap
/// @param multipath       for two_return and tail, except for `status_thresholds`
/// @throws InvalidArgument if the method cannot decode this table
std::unique_ptr<const DepthDecoder> make_decoder(
    DecodeMethod method, DecodingTable table, const DecodeOptions& status_thresholds = {},
    UnwrapWeights unwrap_weights = UnwrapWeights::variance, const MultipathOptions& multipath = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decode_method.hpp"

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
constexpr EnumWords<DecodeMethod, 5> method_words("DecodeMethod", "method", "zncc", "ml", "unwrap",
                                                  "two-return", "tail");
}  // namespace

std::string_view name_of(DecodeMethod method) { return method_words.of(method); }

DecodeMethod parse_decode_method(std::string_view name) { return method_words.parse(name); }

AnyDecoder make_decoder(DecodeMethod method, DecodingTable table,
                        const DecodeOptions& status_thresholds, UnwrapWeights unwrap_weights,
                        const MultipathOptions& multipath) {
  if (method == DecodeMethod::zncc) return Decoder(std::move(table), status_thresholds);
  if (method == DecodeMethod::ml) return LikelihoodDecoder(std::move(table), status_thresholds);
  if (method == DecodeMethod::two_return || method == DecodeMethod::tail) {
    MultipathOptions options = multipath;
    options.status_thresholds = status_thresholds;
    if (method == DecodeMethod::tail) return TailDecoder(std::move(table), options);
    return TwoReturnDecoder(std::move(table), options);
  }
  return UnwrapDecoder(std::move(table),
                       {.status_thresholds = status_thresholds, .weights = unwrap_weights});
}

}  // namespace tofsmith

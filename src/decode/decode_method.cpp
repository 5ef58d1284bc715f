// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decode_method.hpp"

#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::string_view name_of(DecodeMethod method) {
  switch (method) {
    case DecodeMethod::zncc:
      return "zncc";
    case DecodeMethod::ml:
      return "ml";
    case DecodeMethod::unwrap:
      return "unwrap";
    case DecodeMethod::two_return:
      return "two-return";
    case DecodeMethod::tail:
      return "tail";
  }
  reject("DecodeMethod", std::to_string(static_cast<int>(method)), "must be in [0, 4]");
}

DecodeMethod parse_decode_method(std::string_view name) {
  for (const DecodeMethod method : all_decode_methods)
    if (name == name_of(method)) return method;
  reject("method", name, "must be zncc, ml, unwrap, two-return or tail");
}

AnyDecoder make_decoder(DecodeMethod method, DecodingTable table, const DecodeOptions& doubt,
                        UnwrapWeights unwrap_weights, const MultipathOptions& multipath) {
  if (method == DecodeMethod::zncc) return Decoder(std::move(table), doubt);
  if (method == DecodeMethod::ml) return LikelihoodDecoder(std::move(table), doubt);
  if (method == DecodeMethod::two_return || method == DecodeMethod::tail) {
    MultipathOptions options = multipath;
    options.doubt = doubt;
    if (method == DecodeMethod::tail) return TailDecoder(std::move(table), options);
    return TwoReturnDecoder(std::move(table), options);
  }
  return UnwrapDecoder(std::move(table), {.doubt = doubt, .weights = unwrap_weights});
}

}  // namespace tofsmith

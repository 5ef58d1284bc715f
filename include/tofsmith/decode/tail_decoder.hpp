// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

/// Direct depth of pixels behind whose return light trails off, as in haze and translucent things:
///   y' = T o (S1 chi(z) + S2 integral_0^inf exp(-u / L) / L chi(z + u) du + A kappa) + noise,
/// S1 >= S2 >= 0, with the mean delay L = MultipathOptions::tail_m known. All else is as in
/// TwoReturnDecoder; a place tried is one depth with its tail, and only depth goes downhill.
/// The delay it gives is tail_m where a tail was found, the ratio the light of all of the tail
/// beside the direct return's.
class TailDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 5 (4 where ambient light cancels)
  explicit TailDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// As TwoReturnDecoder::why_not_decodable(), of a tail.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

}  // namespace tofsmith

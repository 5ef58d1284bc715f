// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "decode/output/shared/decoder_parts.hpp"
#include "gpu/decode_parameters.h"

namespace tofsmith {

/// decode_parameters.h, numbers.cl, bins.cl and planes.cl, one behind the other.
extern const std::string_view decode_kernels;

/// All that a decoder decides by, as a device reads it.
struct DecodeTables {
  /// @param has_doubles  whether the device computes with them
  DecodeTables(const Decoder& decoder, bool has_doubles);

  MatchParameters points;  ///< beside which the planes' best points on the chords lie
  MatchParameters bins;    ///< of a coarse table; else as `points`
  bool is_coarse = false;
  OutputParameters outputs;
  std::vector<std::uint32_t> words;  ///< where the tables stand
  std::string options;               ///< that the kernels are compiled with
};

}  // namespace tofsmith

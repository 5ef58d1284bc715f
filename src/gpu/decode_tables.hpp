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

/// Source of the kernels.
extern const std::string_view decode_kernels;

struct DecodeTables {
  DecodeTables(const Decoder& decoder, bool has_doubles);

  MatchParameters points;  ///< find the bins next to the best points on the chords
  MatchParameters bins;    ///< find the best bins of a coarse table, else as `points`
  bool is_coarse = false;
  OutputParameters outputs;
  std::vector<std::uint32_t> words;  ///< contents of all tables
  std::string options;               ///< of the compiler
};

}  // namespace tofsmith

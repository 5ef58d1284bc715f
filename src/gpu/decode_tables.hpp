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

/// Concatenation of decode_parameters.h, numbers.cl, bins.cl and planes.cl.
extern const std::string_view decode_kernels;

/// Tables and parameters of a decoder for kernels.
struct DecodeTables {
  DecodeTables(const Decoder& decoder, bool has_doubles);

  MatchParameters points;  ///< finds the bins next to the best points on the chords
  MatchParameters bins;    ///< finds the best bins of a coarse table, else same as `points`
  bool is_coarse = false;
  OutputParameters outputs;
  std::vector<std::uint32_t> words;  ///< contents of all tables
  std::string options;               ///< compiler options of the kernels
};

}  // namespace tofsmith

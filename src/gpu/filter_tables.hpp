// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "decode/filter/shared/filter_parts.hpp"
#include "gpu/decode_parameters.h"
#include "gpu/filter_parameters.h"

namespace tofsmith {

/// Concatenation of decode_parameters.h, numbers.cl, filter_parameters.h, windows.cl and slopes.cl.
extern const std::string_view filter_kernels;

/// Tables and parameters of a filter for kernels.
struct FilterTables {
  /// @param fuses  use fused multiply-add instructions
  FilterTables(const Filter::Plan& plan, bool fuses);

  FilterParameters parameters{};     ///< without the size of the frame
  std::vector<std::uint32_t> words;  ///< contents of the tables
  std::string source;                ///< of the kernels, with their constants
};

/// Return the first plane of a light set, and the plane of the variance that depths were decoded
/// from, which FilterPlanes lacks.
int light_plane(int set, int measurements);
int before_plane(int measurements);

}  // namespace tofsmith

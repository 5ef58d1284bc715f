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

/// Source of the kernels without their constants.
extern const std::string_view filter_kernels;

struct FilterTables {
  FilterTables(const Filter::Plan& plan, bool fuses);

  FilterParameters parameters{};     ///< without the size of the frame
  std::vector<std::uint32_t> words;  ///< of all tables
  std::string source;                ///< of the kernels, with their constants
};

/// First plane of a light set, and plane of the variance that depths were decoded from.
int light_plane(int set, int measurements);
int before_plane(int measurements);

}  // namespace tofsmith

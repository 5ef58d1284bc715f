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

/// decode_parameters.h, numbers.cl, filter_parameters.h, windows.cl and slopes.cl, one behind the
/// other.
extern const std::string_view filter_kernels;

/// All that a filter knows, as a device reads it.
struct FilterTables {
  /// @param fuses  whether products are added in one step
  FilterTables(const Filter::Plan& plan, bool fuses);

  FilterParameters parameters{};     ///< without sizes of frames
  std::vector<std::uint32_t> words;  ///< where the tables stand
  std::string source;                ///< of the kernels, with constants of theirs
};

/// The first plane of a set of light, and one more than a FilterPlanes has: the variance that
/// depths were found from.
int light_plane(int set, int measurements);
int before_plane(int measurements);

}  // namespace tofsmith

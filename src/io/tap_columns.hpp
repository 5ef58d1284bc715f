// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "tofsmith/io/code_npz.hpp"

namespace tofsmith {

/// Column of measurement exposure x taps + tap.
Eigen::Index column_of(int exposure, int tap, int exposures, int taps,
                       std::optional<TapOrder> order);

/// How many exposures the columns hold.
/// @throws IoError if they are no multiple of the taps, or hold several in an order not told
int exposures_of(Eigen::Index columns, const TapLayout& layout, std::string_view file);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/tap_columns.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

Eigen::Index column_of(int exposure, int tap, int exposures, int taps,
                       std::optional<TapOrder> order) {
  return order == TapOrder::blocked ? tap * exposures + exposure : exposure * taps + tap;
}

int exposures_of(Eigen::Index columns, const TapLayout& layout, std::string_view file) {
  require(layout.taps >= 1, "taps", layout.taps, "must be >= 1");
  if (columns % layout.taps != 0)
    throw IoError(file, fmt::format("found {} columns; expected a multiple of taps = {}", columns,
                                    layout.taps));
  if (layout.taps > 1 && !layout.order)
    throw IoError(file, fmt::format("does not say in which order its columns hold {} taps; "
                                    "expected --tap-order blocked or interleaved",
                                    layout.taps));
  return static_cast<int>(columns) / layout.taps;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void require_grid(const std::string& family, int cells, const FamilyOptions& options) {
  if (!options.exact_grid || options.samples % cells == 0) return;
  const int below = std::max(1, options.samples / cells) * cells, above = below + cells;
  const bool above_is_nearer =
      std::abs(above - options.samples) < std::abs(below - options.samples);
  reject("samples", std::to_string(options.samples),
         fmt::format("{} needs a multiple of {} so that no switching time is rounded; the nearest "
                     "are {} and {} (`--set samples={}`)",
                     family, cells, below, above, above_is_nearer ? above : below));
}

}  // namespace tofsmith

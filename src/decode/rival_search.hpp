// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/arc_search.hpp"

namespace tofsmith {

/// Best bins outside a main lobe: what confidence compares with.
class RivalSearch {
 public:
  RivalSearch(const DirectionTable& directions, const ArcSearch& arcs)
      : directions_(&directions), arcs_(&arcs) {}

  /// Best bin outside the main lobe of `bin`, for a unit vector; -1 if nothing is outside.
  std::int32_t rival(std::int32_t bin, const float* unit) const {
    const Lobe lobe = directions_->main_lobe(bin);
    const std::int32_t samples = directions_->samples();
    if (lobe.end - lobe.begin >= samples) return -1;
    return arcs_->best_bin_within(unit, lobe.end, lobe.begin + samples);
  }

 private:
  const DirectionTable* directions_;
  const ArcSearch* arcs_;
};

}  // namespace tofsmith

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

  /// Whether `rival` is a bin outside the main lobe of `bin`, or rightly -1.
  bool is_rival(std::int32_t bin, std::int32_t rival) const {
    const Lobe& lobe = directions_->main_lobe(bin);
    const std::int32_t length = lobe.end - lobe.begin, samples = directions_->samples();
    if (rival < 0) return length >= samples;
    // Counted from the beginning of the lobe, which may be below 0.
    std::int32_t after = rival - lobe.begin;
    if (after >= samples) after -= samples;
    return after >= length;
  }
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

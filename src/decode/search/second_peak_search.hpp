// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/search/arc_search.hpp"

namespace tofsmith {

/// Best bins outside a main lobe: what confidence compares with.
class SecondPeakSearch {
 public:
  SecondPeakSearch(const DirectionTable& directions, const ArcSearch& arcs)
      : directions_(&directions), arcs_(&arcs) {}

  /// A second peak found for a bin nearby, moved out of the main lobe of `bin` where its edge has
  /// passed it; `unknown` where it is further inside.
  static constexpr std::int32_t unknown = -2;
  std::int32_t moved_out(std::int32_t bin, std::int32_t second_peak) const {
    const Lobe& lobe = directions_->main_lobe(bin);
    const std::int32_t length = lobe.end - lobe.begin, samples = directions_->samples();
    if (length >= samples) return -1;
    if (second_peak < 0) return unknown;
    // Counted from the beginning of the lobe, which may be below 0 and end past N.
    std::int32_t after = second_peak - lobe.begin;
    if (after >= samples) after -= samples;
    if (after < 0) after += samples;
    if (after >= length) return second_peak;
    const std::int32_t edge = samples / 120 + 1;
    if (length - after <= edge) return lobe.end < samples ? lobe.end : lobe.end - samples;
    if (after < edge) return lobe.begin > 0 ? lobe.begin - 1 : lobe.begin - 1 + samples;
    return unknown;
  }
  /// Best bin outside the main lobe of `bin`, for a unit vector; -1 if nothing is outside.
  std::int32_t second_peak(std::int32_t bin, const float* unit) const {
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

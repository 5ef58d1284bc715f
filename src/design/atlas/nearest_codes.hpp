// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the time resolution of a camera as a bandwidth [f0]: the smaller of the frequency at
/// which both arms together have a gain of 1/25, as two Hann responses at f_max, and the f_max of a
/// Hann response as wide as the shortest pulse. Infinite without either limit.
double effective_bandwidth_f0(const Camera& camera);

/// Scales the pulses of the modulation about their centres, so that light at the full peak of one
/// camera is at the full peak of another.
CodeSet fitted_to_peak(const CodeSet& code, double from_peak_factor, double to_peak_factor);

/// Returns codes of the most similar atlas cameras with the same number of taps, for each number of
/// exposures (or the listed ones). The distance is measured in log peak and log effective
/// bandwidth, clamped to the range of the atlas. Codes for both kinds of error are included,
/// unchanged and adapted to the camera's peak; no code exceeds that peak. Codes for the camera's
/// kind of error come first, nearest first.
std::vector<CodeSet> nearest_atlas_codes(const std::vector<AtlasEntry>& atlas, const Camera& camera,
                                         const std::vector<int>& exposures, int cameras);

}  // namespace tofsmith

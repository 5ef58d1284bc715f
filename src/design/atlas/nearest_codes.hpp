// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the time resolution as a bandwidth [f0]: the frequency at which both arms together have
/// a gain of 1/25, as two Hann responses at f_max, or the f_max of a Hann response as wide as the
/// shortest pulse, if smaller. Infinite without either limit.
double effective_bandwidth_f0(const Camera& camera);

/// Scales the pulses of the light about their centres, so that full peak stays full peak.
CodeSet fitted_to_peak(const CodeSet& code, double from_peak_factor, double to_peak_factor);

/// Returns codes of the most similar atlas cameras with the same number of taps, for each (or each
/// listed) number of exposures. Distance: log peak and log effective bandwidth, clamped to the
/// atlas. Codes are included unchanged and adapted to the camera's peak, which they never exceed,
/// for both kinds of error. Those for the camera's kind come first, nearest first.
std::vector<CodeSet> nearest_atlas_codes(const std::vector<AtlasEntry>& atlas, const Camera& camera,
                                         const std::vector<int>& exposures, int cameras);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the time resolution as a bandwidth [f0]: the frequency at which both arms together have
/// a gain of 1/25 (two Hann responses have it at f_max), or the f_max of a Hann response as wide as
/// the shortest pulse, if smaller. Infinite without either limit.
double effective_bandwidth_f0(const Camera& camera);

/// Scales the pulses of the light about their centres.
CodeSet fitted_to_peak(const CodeSet& code, double from_peak_factor, double to_peak_factor);

/// Returns codes of the cameras in the atlas with the most similar peak and bandwidth (log
/// distance) and the same number of taps, for each (or each listed) number of exposures: unchanged
/// and adapted to the camera's peak, for both kinds of error. Codes for the camera's kind come
/// first.
std::vector<CodeSet> nearest_atlas_codes(const std::vector<AtlasEntry>& atlas, const Camera& camera,
                                         const std::vector<int>& exposures, int cameras);

}  // namespace tofsmith

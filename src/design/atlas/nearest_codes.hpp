// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// How fine a camera resolves time [f0]: where both arms together leave 1/25, as two Hann responses
/// do at their f_max, or where a Hann response is as wide as the shortest pulse, whichever is less.
/// Infinite: no limit of either kind.
double effective_bandwidth_f0(const Camera& camera);

/// The code with every pulse of its light longer or shorter about its middle, so that what had the
/// whole of one peak factor has the whole of another.
CodeSet fitted_to_peak(const CodeSet& code, double from_peak_factor, double to_peak_factor);

/// Codes of the atlas for each number of exposures (or those asked for) of the nearest cameras of
/// as many taps, none of a higher peak than the camera's: by the distance of log peak and log
/// effective bandwidth, within what the atlas covers, for either kind of error, as they are and
/// fitted to the camera's peak. Those for the camera's own kind of error come first, the nearest of
/// them first.
std::vector<CodeSet> nearest_atlas_codes(const std::vector<AtlasEntry>& atlas, const Camera& camera,
                                         const std::vector<int>& exposures, int cameras);

}  // namespace tofsmith

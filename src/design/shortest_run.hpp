// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Returns the camera's shortest pulse or gap [periods]; 0 without a limit.
double shortest_run_periods(const Camera& camera);

/// Returns true if every pulse and gap of a binary waveform is at least `shortest_run` long, up to
/// rounding. Always true for sampled waveforms.
bool keeps_shortest_run(const Waveform& waveform, double shortest_run);

/// Returns true if all waveforms of a code keep the shortest run of the camera.
bool keeps_shortest_run(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Returns the camera's shortest pulse or gap [periods], or 0.
double shortest_run_periods(const Camera& camera);

/// Tolerates rounding errors; always true for sampled waveforms.
bool keeps_shortest_run(const Waveform& waveform, double shortest_run);

bool keeps_shortest_run(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The camera's shortest pulse or gap [periods]; 0 if it has none.
double shortest_run_periods(const Camera& camera);

/// Whether every pulse and gap of a binary waveform is at least so long, give or take rounding.
/// Sampled waveforms have none.
bool keeps_shortest_run(const Waveform& waveform, double shortest_run);

/// The same for all waveforms of a code on a camera.
bool keeps_shortest_run(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith

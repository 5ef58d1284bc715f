// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// The first modulation of which the light's generator plays nothing: every pulse falls between
/// its points.
std::optional<BrokenRule> pulse_not_generated(const CodeSet& code, const Camera& camera);

/// What a generated modulation is scaled by to keep the source's average power: 1 / mean above a
/// mean of 1, else 1.
double average_power_scale(const Waveform& modulation);
/// The modulation, scaled so.
Waveform at_average_power(const Waveform& modulation);

/// Whether the light's generator plays modulations that come `rotation_bin` of N bins later as it
/// plays them now, only later: by a whole number of its points, to a sixteenth of a bin. Others it
/// rounds otherwise.
bool plays_alike_rotated(const Camera& camera, int samples, int rotation_bin);

/// Whether the second tap of every exposure is what the first leaves.
bool taps_share_a_generator(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Error for the first modulation whose pulses all fall between the points of the light's
/// generator.
std::optional<BrokenRule> pulse_not_generated(const CodeSet& code, const Camera& camera);

/// Factor that preserves the average power of the source: 1 / mean for a mean above 1, else 1.
double average_power_scale(const Waveform& modulation);
Waveform at_average_power(const Waveform& modulation);

/// Returns true if a delay by `rotation_bin` of N bins is a whole number of points of the light's
/// generator to within 1/16 bin, and so does not change the rounding.
bool plays_alike_rotated(const Camera& camera, int samples, int rotation_bin);

/// Returns true if the second tap of every exposure complements the first.
bool taps_share_a_generator(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith

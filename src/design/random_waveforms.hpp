// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/design_problem.hpp"
#include "tofsmith/core/random.hpp"

namespace tofsmith {

/// A code of zeros, to be written exposure by exposure.
SampledCode empty_code(const WaveformSpace& space);

/// Highest harmonic that the camera lets through well enough to be of use.
int highest_useful_frequency(const DesignProblem& problem);

/// `count` equal pulses, together on for `duty` of the period.
void write_pulses(const WaveformSpace& space, int count, double duty, int exposure,
                  SampledCode& code);

/// Taps open in turn, `frequency` times per period; one tap, half the time.
void write_turns(const WaveformSpace& space, int frequency, double phase, int exposure,
                 SampledCode& code);

/// The tap that is open is the one of the largest of random smooth functions.
void write_smooth_gates(const WaveformSpace& space, int highest_frequency, int exposure,
                        RandomStream& random, SampledCode& code);

/// Light where a random smooth function is largest, as long as the peak demands.
void write_smooth_light(const WaveformSpace& space, int highest_frequency, int exposure,
                        RandomStream& random, SampledCode& code);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// The actual waveforms of a code: what drives the arms of a camera, ahead of their impulse
/// responses.
struct ActualCode {
  std::vector<Waveform> modulation;    ///< one per exposure, mean at most 1
  std::vector<Waveform> demodulation;  ///< one per tap value
};

/// What the camera's generators make of a code; the nominal waveforms where an arm has none.
///   - Rounding may lengthen the pulses of a modulation. The source's average power is fixed: above
///     a mean of 1 the whole waveform is scaled down. Below, it is left as it is, since the peak
///     may be at its limit: the light is then less than nominal.
///   - A sensor of two taps without drain has one generator, which plays the first tap; the second
///     is what the first leaves, 1 - d.
/// @throws std::invalid_argument if a modulation has no pulse that the generator can play
ActualCode actual_code(const CodeSet& code, const Camera& camera);

/// The first modulation of which the light's generator plays nothing: every pulse falls between
/// its points.
std::optional<BrokenRule> pulse_not_generated(const CodeSet& code, const Camera& camera);

/// What a generated modulation is scaled by to keep the source's average power: 1 / mean above a
/// mean of 1, else 1.
double average_power_scale(const Waveform& modulation);

/// Whether the second tap of every exposure is what the first leaves.
bool taps_share_a_generator(const CodeSet& code, const Camera& camera);

/// Output of an arm that is driven with a waveform: the waveform convolved with the arm's impulse
/// response, at t = j / points, j = 0 .. points - 1. Without response: averages over the cells [j,
/// j + 1) / points.
Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points);

}  // namespace tofsmith

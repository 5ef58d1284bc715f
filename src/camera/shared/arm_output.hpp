// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Output of an arm that is driven with a waveform: the waveform convolved with the arm's impulse
/// response, at t = j / points, j = 0 .. points - 1. Without response: averages over the cells [j,
/// j + 1) / points.
Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points);

}  // namespace tofsmith

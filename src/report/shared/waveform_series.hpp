// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

inline constexpr int curve_points = 240;  ///< of a drawn period

/// `points` equal steps over [0, end), end point left out: the x of a drawn period.
std::vector<double> axis_values(int points, double end);

/// A waveform over one period [ns], by its switching times and not on a grid: "as designed"
/// (dotted, only where a generator changes it), "waveform" as generated (thin if there is an
/// impulse response), and the same "after the impulse response".
std::vector<Series> arm_series(const Waveform& nominal, const Waveform& actual,
                               const ImpulseResponse& response, double fundamental_frequency_hz,
                               const LineStyle& style);

/// The same of a mixer by its drives x: the weights 2 x - 1.
std::vector<Series> weight_series(std::vector<Series> drive);

/// The columns of a grid of pairs: modulation, demodulation, correlation function.
std::vector<PanelColumn> waveform_columns(bool is_signed = false);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Returns a camera that models the point-scanning bench of the paper: f0 = 5 MHz (range 29.98 m);
/// N = 300 samples, 3 per point of a generator of 500 MS/s and 14 bits with 100 points per period;
/// one generator and a Hann response of 150 MHz on each arm; p = 15.
///
/// The mixer multiplies the detector signal by 2 d - 1, whose mean equals the difference of two
/// taps with gains d and 1 - d: taps = 2, drain = false, readout = "difference". Ambient light and
/// dark current cancel in the mean (for d of duty 1/2), but not in the noise. The paper's read
/// noise of 20 e per measurement is 20 / sqrt(2) per tap. Shot noise is computed for all light,
/// which is pessimistic where the mixer is not at +1 or -1.
///
/// Signals are 1e6 e/s (assumed for 1 mW of average source power) behind optical densities 3 to 0.
/// The exposure is 0.3 s per point in total.
/// @see Gutierrez-Barragan et al., CVPR 2019, Table 1 and Fig. 9
Camera prototype_camera();

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The paper's point-scanning bench as a camera: f0 = 5 MHz (range 29.98 m); N = 300 samples, 3 for
/// each of the 100 points that a generator of 500 MS/s and 14 bits has per period, one generator on
/// each arm, both behind a Hann response of 150 MHz; p = 15.
///
/// The mixer multiplies the detector's signal by the bipolar demodulation 2 d - 1. In the mean that
/// is exactly the difference of two taps with gains d and 1 - d, so the camera has taps = 2, drain
/// = false, readout = "difference"; one exposure of a code gives one measurement. Ambient light and
/// dark current cancel in the mean (for d of duty 1/2), not in the noise. The paper's read noise of
/// 20 e per measurement is 20 / sqrt(2) per tap. Shot noise is that of all light, exact while the
/// mixer is at +1 or -1; where it is between them, on smoothed edges and for analog demodulation, a
/// real mixer would weight noise by (2 d - 1)^2: the camera is then pessimistic.
///
/// The operating points are signals of 1e6 e/s (our assumption for 1 mW of average source power)
/// behind filters of optical density 3 to 0, and ambient light of 1e3 and 1e4 e/s. Exposure is
/// 0.3 s per point in total, as in the paper's simulations, so that O.D. 1, 2 and 3 give
/// S = 1e5, 1e4 and 1e3 e/s of its grid.
/// @see Gutierrez-Barragan et al., CVPR 2019, Table 1 and Fig. 9
Camera prototype_camera();

}  // namespace tofsmith

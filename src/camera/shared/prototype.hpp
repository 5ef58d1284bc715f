// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// One line of the prototype's parameters.
struct PrototypeSetting {
  std::string name = "prototype";
  double peak_factor = 15.0;             ///< p, >= 1
  double f_max_hz = 150e6;               ///< bandwidth of both generators [Hz], > 0
  double average_source_power_mw = 1.0;  ///< P_ave [mW], > 0
  double signal_at_od0_e_per_s = 1e6;    ///< S per mW of P_ave without a filter [e/s], > 0
  std::vector<double> optical_densities = {3.0, 2.0, 1.0, 0.0};  ///< filters at the source, >= 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// The paper's point-scanning bench as a camera: f0 = 5 MHz (range 29.98 m); N = 300 samples, 3 for
/// each of the 100 points that a generator of 500 MS/s and 14 bits has per period, one generator on
/// each arm, both behind a Hann response of `f_max_hz`.
///
/// The mixer multiplies the detector's signal by the bipolar demodulation 2 d - 1. In the mean that
/// is exactly the difference of two taps with gains d and 1 - d, so the camera has taps = 2, drain
/// = false, readout = "difference"; one exposure of a code gives one measurement. Ambient light and
/// dark current cancel in the mean (for d of duty 1/2), not in the noise. The paper's read noise of
/// 20 e per measurement is 20 / sqrt(2) per tap. Shot noise is that of all light, exact while the
/// mixer is at +1 or -1; where it is between them, on smoothed edges and for analog demodulation, a
/// real mixer would weight noise by (2 d - 1)^2: the camera is then pessimistic.
///
/// The operating points are the signals behind each of the setting's filters, and ambient light of
/// 1e3 and 1e4 e/s. Exposure is 0.3 s per point in all, as in the paper's simulations, so that
/// O.D. 1, 2, 3 at 1 mW are S = 1e5, 1e4, 1e3 e/s of its grid.
/// @throws std::invalid_argument if the setting is invalid
/// @see Gutierrez-Barragan et al., CVPR 2019, Table 1 and Fig. 9
Camera prototype_camera(const PrototypeSetting& setting = {});

/// The settings that stand for Table 1: p = 15 as in Fig. 9 first, then p = 5 and 30, all at the
/// generators' 150 MHz and at the same average power. The paper fixes p = 15, the generators and
/// the filters; the powers, p = 5 and 30, and the signal at O.D. 0 are ours.
std::vector<PrototypeSetting> prototype_settings();

/// Light behind a neutral density filter at the source: the signal falls by 10^-optical_density,
/// ambient light, which does not pass the filter, stays.
/// @throws std::invalid_argument unless optical_density is finite and >= 0
OperatingPoint attenuated(const OperatingPoint& point, double optical_density);

}  // namespace tofsmith

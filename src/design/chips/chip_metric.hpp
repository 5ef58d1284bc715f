// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Root mean square over depth of the smallest standard deviation of unbiased depth estimates [m],
/// signal and ambient light unknown:
///   sqrt(gamma), gamma = mean over z of [inverse Fisher matrix over (z, S, A)]_zz,
/// with variances v_i = T_e (S chi_i + A kappa_i + dark) + constant. chi is linear within a chip;
/// the mean over a chip is taken by Gauss-Legendre quadrature with four nodes. Infinite where depth
/// cannot be separated from signal and ambient light.
/// @throws std::invalid_argument if the code or the camera is invalid, or the camera has what the
///         metric leaves out: impulse responses, generators, contrast below 1, differences of taps,
///         exposures of different lengths
double chip_metric_rms_m(const ChipCode& code, const Camera& camera, const OperatingPoint& point);

/// Whether two depths give measurements that light levels can make equal: directions of
/// chi(z) without what ambient light explains that coincide, or vanish, at some pair of real
/// depths. Decided in integers, without rounding.
/// @throws std::invalid_argument if the code is invalid
bool is_ambiguous(const ChipCode& code);

/// How far apart depths are in noise: the least, over all pairs of real depths (z, z') at least
/// `separation_periods` apart around the range and over all S' >= 0 and A', of
///   | mu(z, S, A) - mu(z', S', A') |, whitened by the variances at (z, S, A).
/// @return a proven lower bound, not more than one in a thousand below the least distance [standard
///         deviations]; 0 where the distance is below 1e-3
/// @throws std::invalid_argument as chip_metric_rms_m; or unless the separation is in (0, 1/2)
double ambiguity_margin_sigma(const ChipCode& code, const Camera& camera,
                              const OperatingPoint& point, double separation_periods = 1.0 / 36.0);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Computes the RMS over depth of the standard deviation of the best unbiased depth estimate [m]:
///   sqrt(gamma), gamma = mean over z of [inverse Fisher matrix over (z, S, A)]_zz,
/// or, with known light, the mean of 1 / [Fisher matrix]_zz,
/// with variances v_i = T_e (S chi_i + A kappa_i + dark) + constant. Infinite if depth cannot be
/// separated from light levels.
/// @throws std::invalid_argument for an invalid code or camera, or for properties that are not
///   modelled: impulse responses, generators, contrast below 1, differences of taps, unequal
///   exposures
double chip_metric_rms_m(const ChipCode& code, const Camera& camera, const OperatingPoint& point,
                         ChipMetric metric = ChipMetric::unknown_light);

/// Returns true if two real depths can have equal measurements at suitable light levels. Exact
/// (integers).
/// @throws std::invalid_argument if the code is invalid
bool is_ambiguous(const ChipCode& code);

/// Computes the smallest noise-normalized distance between depths: the minimum over all depths z,
/// z' with a circular distance of at least `separation_periods`, and over all S' >= 0 and A', of
///   | mu(z, S, A) - mu(z', S', A') |, whitened by the variances at (z, S, A).
/// @return a proven lower bound, tight to 0.1 % [standard deviations]; 0 below 1e-3
/// @throws std::invalid_argument as chip_metric_rms_m(), or unless the separation is in (0, 1/2)
double ambiguity_margin_sigma(const ChipCode& code, const Camera& camera,
                              const OperatingPoint& point, double separation_periods = 1.0 / 36.0);

}  // namespace tofsmith

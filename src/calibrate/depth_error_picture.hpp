// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibrate/depth_term_choice.hpp"

namespace tofsmith {

/// The errors of a fit and what it leaves of them.
/// @param offset_m  mean error, taken off beside the fit's start
/// @param fitted_m  of every sample
DepthErrorPicture picture_of(const DepthFit& fit, const Eigen::VectorXd& fitted_m, double offset_m);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibrate/depth_term_choice.hpp"

namespace tofsmith {

/// Returns the errors and residuals of a fit.
/// @param offset_m  mean error, subtracted as well
/// @param fitted_m  fitted error of every sample
DepthErrorPicture picture_of(const DepthFit& fit, const Eigen::VectorXd& fitted_m, double offset_m);

}  // namespace tofsmith

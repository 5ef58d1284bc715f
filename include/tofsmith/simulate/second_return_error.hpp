// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/camera/second_returns.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// evaluate() where every trial has a second return: error of the direct depth, decoded as if there
/// were one return. Depths are those of evaluate(); bounds are left at 0.
/// @throws std::invalid_argument as evaluate(); Interrupted
DepthErrorReport second_return_error(const CodeSet& code, const Camera& camera,
                                     const SecondReturns& later,
                                     const EvaluateOptions& options = {},
                                     const Progress& progress = {});

/// The same decoded as two returns: geometric mean of the circular error over the operating points
/// [m].
/// @throws std::invalid_argument also for codes that cannot tell two returns
Estimate two_return_error_m(const CodeSet& code, const Camera& camera, const SecondReturns& later,
                            const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith

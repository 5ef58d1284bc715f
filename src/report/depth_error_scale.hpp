// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tofsmith/report/figure.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A value at every operating point of a code, signal by ambient.
HeatMap operating_map(const OperatingRange& range, const DepthErrorReport& error,
                      const std::function<double(const PointDepthError&)>& value);

/// Maps of several codes over the operating points.
Figure operating_maps(FigureText text, const OperatingRange& range,
                      const std::vector<HeatMap>& maps, const ColourScale& colours);

/// Colours of decoded minus true depth: white is right, both ends are off by the limit.
ColourScale depth_error_scale(double limit_mm);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/core/array.hpp"
#include "tofsmith/report/colours.hpp"

namespace tofsmith {

/// Every value times `factor`, e.g. metres to millimetres.
Image<float> scaled(Image<float> image, double factor);

/// Colours of decoded minus true depth: white is right, both ends are off by the limit.
ColourScale depth_error_scale(double limit_mm);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/ideal_code_fit.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::apps {

/// Measured table with its errors and the best ideal code, harmonics, and maps.
Page correlation_page(const CalibratedCorrelation& found, const std::vector<IdealCodeFit>& fits,
                      const std::string& file);

}  // namespace tofsmith::apps

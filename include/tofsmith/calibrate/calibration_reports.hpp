// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Return the rows of a table, headings first. A last row lists the parameters that are not
/// determined.
std::vector<std::vector<std::string>> response_rows(const CalibratedResponse& found);
std::vector<std::vector<std::string>> depth_term_rows(const CalibratedDepth& found);
/// Returns offset, contrast and harmonics of each frequency; empty for a single frequency.
std::vector<std::vector<std::string>> frequency_rows(const CalibratedDepth& found);
std::vector<std::vector<std::string>> noise_rows(const PhotonTransfer& found);

/// Returns mean and spread of the nominal depth error, and the remaining error, as a phrase.
std::string depth_error_text(const CalibratedDepth& found);

/// Return pages with the results of calibrations.
/// @param source        name of the data, e.g. a file
/// @param command_line  shown on the page; may be empty
Page response_report(const CalibratedResponse& found, const std::string& source,
                     const std::string& command_line);
Page correlation_report(const CalibratedCorrelation& found, const std::vector<IdealCodeFit>& fits,
                        const std::string& source, const std::string& command_line);
Page depth_report(const CalibratedDepth& found, const std::string& source,
                  const std::string& command_line);
Page temperature_report(const TemperatureDrift& found, const std::string& source,
                        const std::string& command_line);
Page stray_light_report(const CalibratedStrayLight& found, const std::string& source,
                        const std::string& command_line);
Page noise_report(const PhotonTransfer& found, const std::string& command_line);

}  // namespace tofsmith

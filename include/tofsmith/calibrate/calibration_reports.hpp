// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// The lines of a table of what fits a record, headings first, of the terms of a depth error, and
/// of what a sensor's noise is. Terms that are not told apart are left out, but for a last line on
/// them.
std::vector<std::vector<std::string>> response_rows(const CalibratedResponse& found);
std::vector<std::vector<std::string>> depth_term_rows(const CalibratedDepth& found);
/// Offset, contrast and harmonics of each frequency, as rows with a header; empty for a single
/// frequency.
std::vector<std::vector<std::string>> frequency_rows(const CalibratedDepth& found);
std::vector<std::vector<std::string>> noise_rows(const PhotonTransfer& found);

/// Pages of calibrations: what was found, as tables and figures, and the notes.
/// @param source        what was calibrated, such as the file of a record
/// @param command_line  as typed, to be shown on the page; may be empty
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

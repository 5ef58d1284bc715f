// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// The lines of a table of what generators make of each waveform, headings first.
std::vector<std::vector<std::string>> generator_report_rows(
    const std::vector<GeneratorReport>& reports);

/// The lines of a table of what that costs in depth error, headings first.
std::vector<std::vector<std::string>> generator_loss_rows(const GeneratorLoss& loss,
                                                          DepthErrorKind kind);

/// A page of an export: nominal and actual waveforms, correlation functions, and the depth
/// error that the limits cost.
/// @param actual  the camera that exporting_camera() made
/// @param loss    none if it was not measured
Page export_page(const CodeSet& code, const Camera& actual, const WaveformExport& exported,
                 const std::optional<GeneratorLoss>& loss, const std::string& command_line);

}  // namespace tofsmith

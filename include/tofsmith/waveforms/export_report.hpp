// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/write_export.hpp"

namespace tofsmith {

/// The lines of a table of what generators make of each waveform, headings first.
std::vector<std::vector<std::string>> generator_report_rows(
    const std::vector<GeneratorReport>& reports);

/// The lines of a table of what that costs in depth error, headings first.
std::vector<std::vector<std::string>> generator_loss_rows(const GeneratorLoss& loss,
                                                          DepthErrorKind kind);

/// A page of an export: nominal and actual waveforms, correlation functions, and the depth
/// error that the limits cost.
Page export_page(const ExportedCode& exported, const std::string& command_line);

}  // namespace tofsmith

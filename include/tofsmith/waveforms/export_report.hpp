// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/write_export.hpp"

namespace tofsmith {

/// Returns a table of the waveforms that the generators output, headings first.
std::vector<std::vector<std::string>> generator_report_rows(
    const std::vector<GeneratorReport>& reports);

/// Returns a table of the resulting change in depth error, headings first.
std::vector<std::vector<std::string>> generator_loss_rows(const GeneratorLoss& loss,
                                                          DepthErrorKind kind);

/// Returns the page of an export: waveforms, correlation functions and depth error.
Page export_page(const ExportedCode& exported, const std::string& command_line);

}  // namespace tofsmith

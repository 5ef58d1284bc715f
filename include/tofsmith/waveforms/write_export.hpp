// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// Result of exporting a code.
struct ExportedCode {
  CodeSet code;   ///< resampled to the camera's samples
  Camera actual;  ///< with the generators of the tables
  WaveformExport waveforms;
  std::string manifest;
  std::vector<ExportedScript> scripts;  ///< for the generators that support the tables
  std::vector<GeneratorReport> generators;
  std::optional<GeneratorLoss> loss;  ///< if requested
  std::vector<std::string> notes;     ///< for the user
  std::filesystem::path output;
  /// Written files. In a directory: tables, scripts, manifest.json and report.html.
  std::vector<std::filesystem::path> files;
};

struct ExportRequest {
  ExportOptions options;
  /// A directory for all files, or one file with the format's extension, if it stores all
  /// waveforms.
  std::filesystem::path output;
  OutputPolicy policy = OutputPolicy::refuse_existing;
  std::optional<EvaluateOptions> loss;  ///< evaluation of the depth error; none: not evaluated
  /// Contents of report.html, e.g. export_page(); only for directories.
  std::function<std::string(const ExportedCode&)> page;

  /// @throws std::invalid_argument naming output, if it cannot be one file, or format
  bool is_one_file() const;
};

/// Writes all waveforms of a code, or no file.
/// @throws std::invalid_argument as exporting_camera(), export_waveforms(), generator_loss() and
///         is_one_file(); IoError if a file exists or cannot be written; Interrupted
ExportedCode write_export(const CodeSet& code, const Camera& camera, const ExportRequest& request,
                          const Progress& progress = {});

/// Returns the output of `tofsmith export --json`.
std::string export_document(const ExportedCode& exported);

}  // namespace tofsmith

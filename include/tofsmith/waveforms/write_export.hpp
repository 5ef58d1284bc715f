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
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

/// What became of a code on the hardware that it is exported for.
struct ExportedCode {
  CodeSet code;                         ///< at the camera's samples
  Camera actual;                        ///< with the generators that play the tables
  WaveformExport waveforms;             ///< the tables
  std::string manifest;                 ///< manifest.json
  std::vector<ExportedScript> scripts;  ///< SCPI for the generators that can play the tables
  std::vector<GeneratorReport> generators;
  std::optional<GeneratorLoss> loss;  ///< if it was asked for
  std::vector<std::string> notes;     ///< what a user should know
  std::filesystem::path output;       ///< as asked for
  /// Written files: tables first; in a directory then scripts, manifest.json and report.html.
  std::vector<std::filesystem::path> files;
};

/// A code to be written for hardware.
struct ExportRequest {
  ExportOptions options;
  /// A directory, made if it is missing, for all files; or one file, which must have the format's
  /// extension, of a format that holds all waveforms in one.
  std::filesystem::path output;
  OutputPolicy policy = OutputPolicy::refuse_existing;
  std::optional<EvaluateOptions> loss;  ///< how to measure what the limits cost; none: it is not
  /// report.html of a directory, such as export_page(); none: it is not written.
  std::function<std::string(const ExportedCode&)> page;

  /// Whether `output` is one file. @throws std::invalid_argument naming output, if it cannot be
  /// one, or format
  bool is_one_file() const;
};

/// Writes all waveforms of a code as files; all of them can be written before the first is.
/// @throws std::invalid_argument as exporting_camera(), export_waveforms(), generator_loss() and
///         ExportRequest::is_one_file(); IoError if a file exists or cannot be written; Interrupted
///         if progress says so
ExportedCode write_export(const CodeSet& code, const Camera& camera, const ExportRequest& request,
                          const Progress& progress = {});

/// What `tofsmith export --json` prints: manifest, generators, depth error and notes.
std::string export_document(const ExportedCode& exported);

}  // namespace tofsmith

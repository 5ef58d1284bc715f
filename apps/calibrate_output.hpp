// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "session.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::apps {

void add_calibrate_response(CLI::App& calibrate, Session& session);
void add_calibrate_correlation(CLI::App& calibrate, Session& session);
void add_calibrate_noise(CLI::App& calibrate, Session& session);
void add_calibrate_temperature(CLI::App& calibrate, Session& session);
void add_calibrate_stray_light(CLI::App& calibrate, Session& session);

/// Outputs of all calibrations: a camera and a page.
struct CalibrateOutput {
  std::string camera_path;                              ///< .toml; empty: none
  std::string page_path;                                ///< .html; empty: none
  OutputPolicy policy = OutputPolicy::refuse_existing;  ///< of all outputs, set by check()

  void add_to(CLI::App& command);
  /// Checks these outputs and `others` (empty: none) before the computation.
  /// @throws UsageError, IoError
  void check(const Session& session, const std::vector<std::string>& others = {});
  /// @param next  suggested next command; empty: a design for the camera
  void write_camera(const Camera& camera, const Session& session,
                    const std::string& next = "") const;
  void write_page(const Page& page, const Session& session) const;
};

/// Converts an error to one that names the file with the invalid field.
/// @param file      file of all fields not in by_field
/// @param by_field  fields and their files
IoError wrong_file(const std::invalid_argument& error, const std::string& file,
                   const std::map<std::string, std::string>& by_field);

/// Returns {"value": ..., "standard_error": ...}; null for non-finite numbers.
nlohmann::ordered_json estimate_json(const Estimate& estimate);
/// Returns a number, or null if it is not finite.
nlohmann::ordered_json number_json(double value);
/// Returns a line "note: ..." for each note.
std::string note_lines(const std::vector<std::string>& notes);

}  // namespace tofsmith::apps

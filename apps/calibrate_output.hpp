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

/// Adds one of the calibrations to `calibrate`.
void add_calibrate_response(CLI::App& calibrate, Session& session);
void add_calibrate_correlation(CLI::App& calibrate, Session& session);
void add_calibrate_noise(CLI::App& calibrate, Session& session);
void add_calibrate_temperature(CLI::App& calibrate, Session& session);
void add_calibrate_stray_light(CLI::App& calibrate, Session& session);

/// What all calibrations write: a camera and a page.
struct CalibrateOutput {
  std::string camera_path;                              ///< .toml, or ""
  std::string page_path;                                ///< .html, or ""
  OutputPolicy policy = OutputPolicy::refuse_existing;  ///< of all outputs, once they are checked

  void add_to(CLI::App& command);
  /// Looks at the outputs before the work, these and others ("": none). @throws UsageError, IoError
  void check(const Session& session, const std::vector<std::string>& others = {});
  /// @param next  the command that comes next; "": a design for it
  void write_camera(const Camera& camera, const Session& session,
                    const std::string& next = "") const;
  void write_page(const Page& page, const Session& session) const;
};

/// What is wrong with the files of a calibration, naming the one that holds the field.
/// @param file     of all other fields
/// @param by_field fields and their files
IoError wrong_file(const std::invalid_argument& error, const std::string& file,
                   const std::map<std::string, std::string>& by_field);

/// {"value": .., "standard_error": ..}; null where it is no number.
nlohmann::ordered_json estimate_json(const Estimate& estimate);
/// A number, or null where it is none.
nlohmann::ordered_json number_json(double value);
/// "name: note" lines.
std::string note_lines(const std::vector<std::string>& notes);

}  // namespace tofsmith::apps

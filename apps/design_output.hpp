// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "number_checks.hpp"
#include "session.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith::apps {

inline void add_effort(CLI::App& command, double& effort) {
  command
      .add_option("--effort", effort,
                  "search effort: 0.1 for a quick result, 3 for the last percent of "
                  "improvement; 0: no search, only rank atlas codes and standard codes")
      ->check(number_that("0 or in [0.01, 100]",
                          [](double its) { return its == 0.0 || (its >= 0.01 && its <= 100.0); }))
      ->capture_default_str();
}

/// Prints candidates by ascending depth error, or the design document with --json.
void print_design(const Session& session, const Camera& camera, const DesignResult& result,
                  const DesignOptions& options);

/// Writes the report of a directory (a design and, if present, its scene) to DIRECTORY/report.html.
void write_report(const Session& session, const std::filesystem::path& directory,
                  OutputPolicy policy);

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "session.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith::apps {

/// Prints candidates by ascending depth error, or the design document with --json.
void print_design(const Session& session, const Camera& camera, const DesignResult& result,
                  const DesignOptions& options);

/// Writes the report of a directory (a design and, if present, its scene) to DIRECTORY/report.html.
void write_report(const Session& session, const std::filesystem::path& directory,
                  OutputPolicy policy);

}  // namespace tofsmith::apps

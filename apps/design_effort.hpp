// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "tofsmith/design/design.hpp"

namespace tofsmith::apps {

/// The option `--effort`.
void add_effort(CLI::App& command, double& effort);

/// Searches longer, or shorter, by the factor `effort`.
void scale_effort(DesignOptions& options, double effort);

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "number_checks.hpp"

namespace tofsmith::apps {

inline void add_effort(CLI::App& command, double& effort) {
  command
      .add_option("--effort", effort,
                  "how long to search: 0.1 for a first look, 3 for the last percent; 0: not at "
                  "all, codes of the atlas and standard codes are judged")
      ->check(number_that("0 or in [0.01, 100]",
                          [](double its) { return its == 0.0 || (its >= 0.01 && its <= 100.0); }))
      ->capture_default_str();
}

}  // namespace tofsmith::apps

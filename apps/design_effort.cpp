// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design_effort.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith::apps {

void add_effort(CLI::App& command, double& effort) {
  command
      .add_option("--effort", effort,
                  "how long to search: 0.1 for a first look, 3 for the last percent")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
}

void scale_effort(DesignOptions& options, double effort) {
  const auto scale = [effort](int& count, int least) {
    count = std::max(least, static_cast<int>(std::lround(effort * count)));
  };
  scale(options.optimize.starts, 2);
  scale(options.optimize.hops, 0);
  scale(options.optimize.refinement_steps, 50);
  scale(options.factorize.random_starts, 2);
  scale(options.search.annealing_starts, 2);
}

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith::apps {

/// How multipath is looked for: `--threshold`, `--shortest-delay`, `--longest-delay`,
/// `--tail-length`, `--bayes` and its prior.
class MultipathArguments {
 public:
  void add_to(CLI::App& command) {
    command
        .add_option("--threshold", options_.threshold,
                    "two-return, tail: how much chi^2 must fall for a second return to count")
        ->check(number_from_0_on())
        ->capture_default_str()
        ->group(for_experts);
    command
        .add_option("--shortest-delay", options_.shortest_delay_m,
                    "two-return: shortest delay of a second return [m]")
        ->check(positive_number())
        ->capture_default_str()
        ->group(for_experts);
    command
        .add_option("--longest-delay", options_.longest_delay_m,
                    "two-return: longest delay of a second return [m] (a third of the range)")
        ->check(positive_number())
        ->group(for_experts);
    command
        .add_option("--tail-length", options_.tail_m,
                    "tail: mean delay of the light that trails off [m]")
        ->check(positive_number())
        ->capture_default_str()
        ->group(for_experts);
    CLI::Option* bayes = command
                             .add_flag("--bayes", bayes_,
                                       "two-return, tail: depth is the posterior median under a "
                                       "prior, where one return does not "
                                       "explain the pixel")
                             ->group(for_experts);
    command
        .add_option("--prior-single", prior_.single_probability,
                    "prior probability that there is no second return")
        ->capture_default_str()
        ->needs(bayes)
        ->group(for_experts);
    command
        .add_option("--prior-delay", prior_.mean_delay_m,
                    "prior mean of delays, which are exponential [m]")
        ->capture_default_str()
        ->needs(bayes)
        ->group(for_experts);
    command
        .add_option("--prior-ratio", prior_.max_ratio, "prior of ratios: uniform from 0 to this")
        ->capture_default_str()
        ->needs(bayes)
        ->group(for_experts);
  }
  MultipathOptions options() const {
    MultipathOptions options = options_;
    if (bayes_) options.prior = prior_;
    return options;
  }

 private:
  MultipathOptions options_;
  ReturnPrior prior_;
  bool bayes_ = false;
};

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith::apps {

/// Options of the decoding method: `--method`, `--unwrap-weights`.
class MethodArguments {
 public:
  void add_to(CLI::App& command) {
    CLI::Option* method =
        add_option_of(command, Field("method", method_, decode_method_help), "--method");
    add_option_of(command,
                  Field("unwrap_weights", weights_, unwrap_weights_help, unwrap_weights_condition),
                  "--unwrap-weights")
        ->needs(method)
        ->group(for_experts);
  }
  DecodeMethod method() const { return method_; }
  UnwrapWeights unwrap_weights() const { return weights_; }

 private:
  DecodeMethod method_ = DecodeMethod::zncc;
  UnwrapWeights weights_ = UnwrapWeights::variance;
};

/// Options of multipath decoding: `--threshold`, `--shortest-delay`, `--longest-delay`,
/// `--tail-length`, `--bayes` and its prior.
class MultipathArguments {
 public:
  void add_to(CLI::App& command) {
    const FieldOptions fields(command, options_);
    fields.add("threshold")->group(for_experts);
    fields.add("shortest_delay_m", "--shortest-delay")->group(for_experts);
    fields.add("longest_delay_m", "--longest-delay")->check(positive_number())->group(for_experts);
    fields.add("tail_m", "--tail-length")->group(for_experts);
    CLI::Option* bayes = command
                             .add_flag("--bayes", bayes_,
                                       "use the posterior median of the depth where one return "
                                       "does not explain the measurements; only with method "
                                       "two-return or tail")
                             ->group(for_experts);
    const FieldOptions prior(command, prior_);
    prior.add("single_probability", "--prior-single")->needs(bayes)->group(for_experts);
    prior.add("mean_delay_m", "--prior-delay")->needs(bayes)->group(for_experts);
    prior.add("max_ratio", "--prior-ratio")->needs(bayes)->group(for_experts);
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

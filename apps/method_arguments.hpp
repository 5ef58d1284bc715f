// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "tofsmith/decode/decode_method.hpp"

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

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "help_pages.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith::apps {

/// Which decoder turns measurements into depth: `--method`, `--unwrap-weights`.
class MethodArguments {
 public:
  void add_to(CLI::App& command) {
    CLI::Option* method = command
                              .add_option("--method", method_,
                                          "decoder: zncc for any code, ml for any code by maximum "
                                          "likelihood (slower), unwrap "
                                          "for sinusoids of one or more frequencies; two-return "
                                          "and tail where light comes back twice or trails off, "
                                          "for codes of many independent means")
                              ->check(one_of({"zncc", "ml", "unwrap", "two-return", "tail"}))
                              ->capture_default_str();
    command
        .add_option("--unwrap-weights", weights_,
                    "how unwrapping weighs frequencies: by the variance of their depth on this "
                    "camera, or by f^2, as is classical")
        ->check(one_of({"variance", "frequency"}))
        ->capture_default_str()
        ->needs(method)
        ->group(for_experts);
  }
  DecodeMethod method() const { return parse_decode_method(method_); }
  UnwrapWeights unwrap_weights() const { return parse_unwrap_weights(weights_); }

 private:
  std::string method_ = "zncc";
  std::string weights_ = "variance";
};

}  // namespace tofsmith::apps

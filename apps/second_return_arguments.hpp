// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "session.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith::apps {

/// Second returns that designed codes shall stand: `--second-returns`, `--second-return-weight`,
/// `--two-return-weight`.
class SecondReturnArguments {
 public:
  void add_to(CLI::App& command);
  /// Puts what was asked for into operating.multipath, over what the camera says there.
  /// @throws UsageError for what cannot be read or be
  void apply_to(Camera& camera) const;
  /// @throws UsageError for a weight of two returns on a camera that meets none
  void apply_to(OptimizeOptions& options, const Camera& camera) const;

 private:
  std::string returns_;
  std::optional<double> weight_, two_return_weight_;
};

}  // namespace tofsmith::apps

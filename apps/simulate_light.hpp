// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith::apps {

/// Light that comes back by longer ways: `--multipath`, `--tail`, `--multipath-file`,
/// `--transient`,
/// `--bounces`, and `--truth-multipath` for what was simulated.
class MultipathLightArguments {
 public:
  void add_to(CLI::App& command);
  /// @throws UsageError for words that do not fit each other; IoError as the files' readers;
  ///         std::invalid_argument as SceneLight::validate
  SceneLight load(const LoadedScene& scene, const Camera& camera) const;
  /// Whether anything was asked for.
  bool is_used() const {
    return !multipath_.empty() || tail_m_ || !returns_.empty() || !transient_.empty() ||
           bounces_ > 0 || !truth_.empty();
  }
  const std::string& truth() const { return truth_; }

 private:
  MultipathReturns bounced(const LoadedScene& scene, const Camera& camera) const;

  std::vector<std::string> multipath_;
  std::optional<double> tail_m_;
  double tail_ratio_ = 0.3;
  std::string returns_, transient_, truth_;
  std::optional<double> transient_bin_s_;
  int bounces_ = 0;
  BounceOptions bounce_;
  std::string transient_origin_ = "first", transient_background_ = "none";
};

}  // namespace tofsmith::apps

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith::apps {

/// Options of simulated multipath: `--multipath`, `--tail`, `--multipath-file`, `--transient`,
/// `--bounces`, and `--truth-multipath` for its ground truth.
class MultipathLightArguments {
 public:
  void add_to(CLI::App& command);
  /// @throws UsageError for contradictory options; IoError as the readers of the files;
  ///   std::invalid_argument as SceneLight::validate()
  SceneLight load(const LoadedScene& scene, const Camera& camera) const;
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
  TransientFileOptions transients_;
  CLI::Option* transient_bin_ = nullptr;  ///< of the command
  int bounces_ = 0;
  BounceOptions bounce_;
};

}  // namespace tofsmith::apps

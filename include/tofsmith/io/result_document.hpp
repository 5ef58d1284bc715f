// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// A code's depth error and how far its origin was moved for it.
struct EvaluatedCode {
  DepthErrorReport error;
  int rotation_bin = 0;
  /// Of DecodeMethod::ml: the error by zncc in the same trials, to compare with.
  std::optional<DepthErrorReport> zncc_error;
  /// On perturbed cameras, if that was asked for.
  std::optional<RobustnessReport> robustness;
};

/// What generators make of each waveform, as JSON: a list of objects.
std::string generators_document(const std::vector<GeneratorReport>& reports);

/// What `tofsmith evaluate --json` prints: version, seed, trials, the camera with its defaults
/// filled in, the decoder, and one entry per code with its depth errors and bounds. Beside what it
/// is compared with stand the ratios of its errors to it; a code's robustness stands in its entry.
std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options);

/// What `tofsmith design --json` prints: the same with one entry per candidate, the name of the
/// best, and how each designed code compares with its target.
std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options);

/// What `tofsmith require --json` prints: camera and options, the error as it is, what of each
/// quantity suffices and what the bound excludes, and the error over bandwidth and power.
std::string requirements_document(const Camera& camera, const Requirements& found,
                                  const RequirementOptions& options);

/// What `tofsmith multipath` found, as JSON: per code, per signal, every cell; what a code cannot
/// do is null.
/// @param scene  what became of a scene, by mean delay of its multipath light; null: none
std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options,
                               const MultipathScene* scene = nullptr);

}  // namespace tofsmith

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

/// Depth error of a code, and the rotation of the code's origin that was used.
struct EvaluatedCode {
  DepthErrorReport error;
  int rotation_bin = 0;
  /// For DecodeMethod::ml: the error of zncc in the same trials, for comparison.
  std::optional<DepthErrorReport> zncc_error;
  /// On perturbed cameras, if requested.
  std::optional<RobustnessReport> robustness;
};

/// Returns the generator limits and errors of each waveform as a JSON list of objects.
std::string generators_document(const std::vector<GeneratorReport>& reports);

/// Returns the output of `tofsmith evaluate --json`: version, seed, trials, the camera with its
/// defaults filled in, the decoder, and one entry per code with depth errors, bounds, their ratios
/// to the errors, and robustness.
std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options);

/// Returns the output of `tofsmith design --json`: evaluation_document() with one entry per
/// candidate, the name of the best code, and a comparison of each designed code with its target.
std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options);

/// Returns the output of `tofsmith require --json`: camera and options, the present error, the
/// required value and the bound of each quantity, and the error over bandwidth and power.
std::string requirements_document(const Camera& camera, const Requirements& found,
                                  const RequirementOptions& options);

/// Returns the result of `tofsmith multipath` as JSON: per code and signal, every cell; unsupported
/// cells are null.
/// @param scene  errors in a scene by mean delay of its multipath light; null: none
std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options,
                               const MultipathScene* scene = nullptr);

}  // namespace tofsmith

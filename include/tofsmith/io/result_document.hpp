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
#include "tofsmith/simulate/interference_error.hpp"
#include "tofsmith/simulate/motion_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

/// Depth error of a code at the rotation that was used.
struct EvaluatedCode {
  DepthErrorReport error;
  int rotation_bin = 0;
  /// For DecodeMethod::ml: the error of zncc in the same trials.
  std::optional<DepthErrorReport> zncc_error;
  std::optional<RobustnessReport> robustness;
  /// With moving surfaces, if the camera has operating.velocity_m_per_s.
  std::optional<MotionReport> motion = {};
  /// With other cameras, if the camera has operating.interference.
  std::optional<InterferenceReport> interference = {};
};

/// Returns the generator limits and errors of each waveform as a JSON list.
std::string generators_document(const std::vector<GeneratorReport>& reports);

/// Returns the output of `tofsmith evaluate --json`, with one entry per code.
std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options);

/// Returns the output of `tofsmith design --json`: evaluation_document() of the candidates, the
/// best code, and comparisons of designed codes with their targets.
std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options);

/// Returns the output of `tofsmith require --json`.
std::string requirements_document(const Camera& camera, const Requirements& found,
                                  const RequirementOptions& options);

/// Returns the output of `tofsmith multipath --json`; unsupported cells are null.
/// @param scene  null: none
std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options,
                               const MultipathScene* scene = nullptr);

}  // namespace tofsmith

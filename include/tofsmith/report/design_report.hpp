// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Report of a design. The first screen contains the best code, the standard codes and a scene;
/// sections with all candidates, maps and waveforms are folded.
/// @param command_line  shown on the page; may be empty
/// @param files  names in the directory of the report to link to; may be empty
Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line,
                   const std::vector<std::string>& files = {});

/// Report of a directory with a design.
Page design_report(const DesignedDirectory& found, const std::string& command_line);

/// Report of codes evaluated on a camera, with zncc and robustness if they were computed.
Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line);

/// Describes the codes that find_requirements() tried.
std::string searched_codes_text(const RequirementOptions& options);

/// Returns the table of changes that reach a target error, headings first.
std::vector<std::vector<std::string>> requirement_rows(const Camera& camera,
                                                       const Requirements& found,
                                                       const RequirementOptions& options);

/// Returns requirement_rows() as a page, with a map of the error over bandwidth and power.
Page requirements_report(const Camera& camera, const Requirements& found,
                         const RequirementOptions& options, const std::string& command_line);

/// A code and its depth error on perturbed cameras.
struct JudgedCode {
  std::string name;
  RobustnessReport robustness;
};

/// Returns the codes that have a robustness report.
std::vector<JudgedCode> judged_codes(std::span<const EvaluatedCode> codes);

/// Returns the robustness table, headings first: every code on every perturbed camera, with ratios
/// to the nominal error, and the worst case.
std::vector<std::vector<std::string>> robustness_rows(const std::vector<JudgedCode>& codes);

/// Returns robustness_rows() as a section.
Section robustness_section(const std::vector<JudgedCode>& codes);

/// Returns true if codes were evaluated with moving surfaces.
bool is_evaluated_with_motion(std::span<const EvaluatedCode> codes);

/// Rows of the table of errors with moving surfaces, headings first: every code, as means over the
/// light levels and optionally at each.
std::vector<std::vector<std::string>> motion_rows(std::span<const EvaluatedCode> codes,
                                                  bool every_level);
/// As above as a section.
Section motion_section(std::span<const EvaluatedCode> codes);

/// Returns true if codes were evaluated with the light of other cameras.
bool is_evaluated_with_interference(std::span<const EvaluatedCode> codes);

/// Rows of the table of errors with other cameras, headings first: every code, as means over the
/// light levels and optionally at each.
std::vector<std::vector<std::string>> interference_rows(std::span<const EvaluatedCode> codes,
                                                        bool every_level);
/// As above as a section.
Section interference_section(std::span<const EvaluatedCode> codes,
                             const OperatingInterference& others);
/// Describes the other cameras: "2 other cameras, each with 0.1 times the signal, ...".
std::string interference_text(const OperatingInterference& others);

/// Returns true if codes were also decoded by zncc.
bool is_compared_with_zncc(std::span<const EvaluatedCode> codes);

/// Returns the table of zncc and maximum likelihood on the same trials, headings first: geometric
/// means and optionally every light level.
std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level);

/// Returns the table of multipath errors per code and signal, headings first.
std::vector<std::vector<std::string>> multipath_rows(
    const std::vector<MultipathErrorReport>& codes);

/// Returns heat maps over (delta, r) of bias and error with their bound, and the table.
Section multipath_section(const std::vector<MultipathErrorReport>& codes);

/// Returns the table of errors by mean delay of the multipath light, headings first.
std::vector<std::vector<std::string>> multipath_scene_rows(const MultipathScene& scene);

/// Returns depths with errors, detected second returns, a view from above, point clouds, and the
/// table.
Section multipath_scene_section(const MultipathScene& scene, const Camera& camera);

}  // namespace tofsmith

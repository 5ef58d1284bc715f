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

/// The report of a design. Its first screen shows the best code and the standard codes, error over
/// light, waveforms, a scene before and after, files and commands; sections with all candidates,
/// maps, waveforms, coding curves, convergence and the scene are folded.
/// @param command_line  as typed, to be shown on the page; may be empty
/// @param files  names in the directory of the report to link to; may be empty
Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line,
                   const std::vector<std::string>& files = {});

/// The same of a directory that holds a design.
Page design_report(const DesignedDirectory& found, const std::string& command_line);

/// Codes evaluated on a camera, with the errors by zncc in the same trials and those on perturbed
/// cameras if they were computed.
Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line);

/// The lines of a table of what it takes to reach an error, headings first.
std::vector<std::vector<std::string>> requirement_rows(const Camera& camera,
                                                       const Requirements& found,
                                                       const RequirementOptions& options);

/// The same as a page, with a map of the error over bandwidth and power.
Page requirements_report(const Camera& camera, const Requirements& found,
                         const RequirementOptions& options, const std::string& command_line);

/// A code and what becomes of its depth error on perturbed cameras.
struct JudgedCode {
  std::string name;
  RobustnessReport robustness;
};

/// The codes that were judged on perturbed cameras.
std::vector<JudgedCode> judged_codes(std::span<const EvaluatedCode> codes);

/// The lines of a table of robustness, headings first: every code on every perturbed camera, each
/// error beside its ratio to the nominal one, and the worst of them.
std::vector<std::vector<std::string>> robustness_rows(const std::vector<JudgedCode>& codes);

/// The same for a page.
Section robustness_section(const std::vector<JudgedCode>& codes);

/// Whether codes were decoded by zncc too.
bool is_compared_with_zncc(std::span<const EvaluatedCode> codes);

/// What zncc makes of the same trials, and how many times as large the errors by maximum likelihood
/// are, as geometric means and, if asked, at every light level; headings first.
std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level);
/// The same for a page.
Section zncc_comparison(std::span<const EvaluatedCode> codes);

/// The lines of a table of errors where light comes back twice, headings first: every code at every
/// signal, single returns, second returns and tails.
std::vector<std::vector<std::string>> multipath_rows(
    const std::vector<MultipathErrorReport>& codes);

/// Heat maps over (delta, r) of bias and error, single-path beside two-return, with their bound,
/// one panel per code and signal; and the table.
Section multipath_section(const std::vector<MultipathErrorReport>& codes);

/// The lines of a table of errors by mean delay of the multipath light, headings first.
std::vector<std::vector<std::string>> multipath_scene_rows(const MultipathScene& scene);

/// True, single-path and two-return depth and errors, where two returns were found, the middle row
/// seen from above, point clouds with and without, and the table.
Section multipath_scene_section(const MultipathScene& scene, const Camera& camera);

}  // namespace tofsmith

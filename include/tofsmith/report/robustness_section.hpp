// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

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

}  // namespace tofsmith

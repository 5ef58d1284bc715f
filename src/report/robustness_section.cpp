// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;

Row row(const std::string& code, const std::string& camera, const Estimate& nominal_m,
        const Estimate& calibrated_m, const Estimate& uncalibrated_m) {
  const auto ratio = [&](const Estimate& error_m) {
    return fmt::format("{:.3f}", error_m.value / nominal_m.value);
  };
  return {code,
          camera,
          estimate_mm_text(calibrated_m),
          ratio(calibrated_m),
          estimate_mm_text(uncalibrated_m),
          ratio(uncalibrated_m)};
}

}  // namespace

std::vector<JudgedCode> judged_codes(std::span<const EvaluatedCode> codes) {
  std::vector<JudgedCode> judged;
  for (const EvaluatedCode& code : codes)
    if (code.robustness) judged.push_back({code.error.code, *code.robustness});
  return judged;
}

std::vector<Row> robustness_rows(const std::vector<JudgedCode>& codes) {
  std::vector<Row> rows{
      {"code", "camera", "calibrated (mm)", "/ nominal", "uncalibrated (mm)", "/ nominal"}};
  for (const JudgedCode& code : codes) {
    const RobustnessReport& r = code.robustness;
    rows.push_back(row(code.name, "nominal", r.nominal_m, r.nominal_m, r.nominal_m));
    for (const PerturbedError& p : r.perturbed)
      rows.push_back(row(code.name, p.name, r.nominal_m, p.calibrated_m, p.uncalibrated_m));
    rows.push_back(
        row(code.name, "worst", r.nominal_m, r.worst_calibrated_m(), r.worst_uncalibrated_m()));
  }
  return rows;
}

Section robustness_section(const std::vector<JudgedCode>& codes) {
  const bool is_linear = codes.empty() || codes.front().robustness.kind == DepthErrorKind::linear;
  std::string caption = fmt::format(
      "{} depth error (geometric mean over the operating points) on cameras that differ from "
      "the nominal camera. Calibrated: decoded with the correlation functions of the actual "
      "camera. Uncalibrated: decoded with the correlation functions of the nominal camera. The "
      "depths and the noise are the same for all cameras, with {} trials per operating point.",
      is_linear ? "Linear" : "Circular", codes.empty() ? 0 : codes.front().robustness.trials);
  return {"Robustness",
          {table_of_rows("robustness", std::move(caption), robustness_rows(codes), {0, 1})}};
}

}  // namespace tofsmith

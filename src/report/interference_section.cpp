// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;

bool has_interference(const EvaluatedCode& code) { return code.interference.has_value(); }

std::string percent_text(double share) { return fmt::format("{:.2f}", 100.0 * share); }

std::string plain_mm(double length_m) {
  return std::isfinite(length_m) ? fmt::format("{:.3f}", 1e3 * length_m) : "";
}

/// @param expected, rms  of one operating point
Row interference_row(const std::string& code, std::string signal, std::string ambient, double rms_m,
                     std::string expected, std::string rms, const Estimate& alone_m,
                     const Estimate& error_m, const WrongShares& shares) {
  const auto detected = shares.detected();
  return {code,
          std::move(signal),
          std::move(ambient),
          plain_mm(rms_m),
          std::move(expected),
          std::move(rms),
          estimate_mm_text(alone_m),
          estimate_mm_text(error_m),
          percent_text(shares.wrong),
          percent_text(shares.wrong_ok),
          detected ? percent_text(*detected) : ""};
}

}  // namespace

bool is_evaluated_with_interference(std::span<const EvaluatedCode> codes) {
  return std::ranges::any_of(codes, has_interference);
}

std::vector<Row> interference_rows(std::span<const EvaluatedCode> codes, bool every_level) {
  std::vector<Row> rows{{"code", "signal (e/s)", "ambient (e/s)", "interference (mm)",
                         "expected rms (mm)", "rms (mm)", "alone (mm)", "error (mm)", "wrong (%)",
                         "wrong ok (%)", "detected (%)"}};
  for (const EvaluatedCode& code : codes) {
    if (!has_interference(code)) continue;
    const InterferenceReport& report = *code.interference;
    const bool is_single = report.points.size() == 1;
    if (!is_single)
      rows.push_back(interference_row(code.error.code, "all", "all", report.rms_m, "", "",
                                      code.error.circular.geometric_mean_m,
                                      report.circular.geometric_mean_m, report.shares));
    for (std::size_t i = 0; (every_level || is_single) && i < report.points.size(); ++i) {
      const InterferencePoint& p = report.points[i];
      rows.push_back(
          interference_row(code.error.code, fmt::format("{:.3g}", p.point.signal_e_per_s),
                           fmt::format("{:.3g}", p.point.ambient_e_per_s), report.rms_m,
                           plain_mm(p.expected_rmse_m), estimate_mm_text(p.circular_rmse_m),
                           code.error.points[i].circular_mde_m, p.circular_mde_m, p.shares));
    }
  }
  return rows;
}

std::string interference_text(const OperatingInterference& others) {
  std::string text = fmt::format("{} other camera{}, each with {} times the signal", others.cameras,
                                 others.cameras == 1 ? "" : "s", others.signal_ratio);
  if (others.code != "same") text += fmt::format(", code {}", others.code);
  if (others.frequency_offset_hz != 0.0)
    text += fmt::format(", frequency offset {} Hz", others.frequency_offset_hz);
  if (others.spreads())
    text += fmt::format(", random {} in {} part{} per exposure",
                        spreadings[static_cast<std::size_t>(others.spreading)], others.parts,
                        others.parts == 1 ? "" : "s");
  return text;
}

Section interference_section(std::span<const EvaluatedCode> codes,
                             const OperatingInterference& others) {
  return {
      "Other cameras",
      {table_of_rows(
          "interference",
          fmt::format(
              "Depth error with the light of {}. Interference: rms error of zncc without noise, to "
              "first order. Expected rms: the same with noise. Rms, error: rms and mean circular "
              "error of trials. Alone: mean circular error without other cameras. Wrong: share of "
              "depths whose error exceeds three predicted standard deviations. Wrong ok: "
              "share of depths that are wrong with status ok. Detected: share of the wrong depths "
              "with status "
              "inconsistent. Rows of all light levels contain geometric means of errors and means "
              "of shares.",
              interference_text(others)),
          interference_rows(codes, true), {0})}};
}

}  // namespace tofsmith
